// The ray of this fragment and the nearest hit found so far, after packed.glsl: the two take the place of ray.glsl and
// nearest.glsl.
layout(location = 4) uniform uvec2 object_range;
layout(location = 0) out uvec4 result;

vec3 origin;
vec3 direction;
float tmin;
float tmax;
uvec4 stored;
float best_t;
float best_distance;
uint best_rank;

vec3 best_normal();

uvec2 begin() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  uvec4 ray = texelFetch(rays, at, 0);
  unpack(ray.xyz, origin, direction);
  vec2 interval = unpackHalf2x16(ray.w);
  tmin = interval.x;
  tmax = interval.y;
  stored = texelFetch(hits, at, 0);
  best_rank = stored.w;
  vec3 position;
  vec3 normal;
  unpack(stored.xyz, position, normal);
  best_distance = best_rank == none ? REAL_MAX : distance(position, origin);
  return object_range;
}

bool consider(float t, uint rank) {
  if (!(t > tmin && t <= tmax)) return false;
  float far_away = distance(origin + t * direction, origin);
  if (!(far_away < best_distance || (far_away == best_distance && rank < best_rank))) return false;
  best_t = t;
  best_distance = far_away;
  best_rank = rank;
  return true;
}

bool enough() { return false; }

vec3 best_position() { return origin + best_t * direction; }

void end() {
  result = stored;
  if (best_rank == stored.w) return;
  vec3 p = best_position();
  vec3 n = best_normal();
  result = uvec4(packHalf2x16(vec2(p.x, n.x)), packHalf2x16(vec2(p.y, n.y)), packHalf2x16(vec2(p.z, n.z)), best_rank);
}
