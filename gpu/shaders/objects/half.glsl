// The ray and the nearest hit in 16-bit halves. Source: Wood, McCane, King, "Ray Tracing Arbitrary Objects on the GPU" (2004),
// figures 4 and 5: r, g, b each hold a component of a position and one of a normal (here also of an origin and a direction);
// a is the object's number in 32 bits. Takes the place of ray.glsl and nearest.glsl.
layout(binding = 0) uniform usampler2D rays;  // r, g, b: origin and direction; a: tmin and tmax
layout(binding = 4) uniform usampler2D hits;  // r, g, b: position and normal; a: rank
layout(location = 4) uniform uvec2 object_range;
layout(location = 0) out uvec4 result;

const uint none = 0xFFFFFFFFu;

vec3 origin;
vec3 direction;
float tmin;
float tmax;
uvec4 stored;
float best_t;
float best_distance;
uint best_rank;

vec3 best_normal();

void unpack(uvec3 packed_halves, out vec3 low, out vec3 high) {
  vec2 x = unpackHalf2x16(packed_halves.x);
  vec2 y = unpackHalf2x16(packed_halves.y);
  vec2 z = unpackHalf2x16(packed_halves.z);
  low = vec3(x.x, y.x, z.x);
  high = vec3(x.y, y.y, z.y);
}

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
