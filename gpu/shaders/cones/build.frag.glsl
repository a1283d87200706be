// One fragment a tile: the cone around its rays, but for those that have ended or miss the frame's cube, which holds all that
// cones are tested against. After prelude.glsl, box.glsl, ray_cone.glsl and ray.glsl.
layout(location = 5) uniform int tile;     // rays along a side
layout(location = 0) out vec4 apex_cosine;
layout(location = 1) out vec4 axis_sine;

const float cube = 1 + 1.0f / 1024;  // and what rounding can make stick out

vec3 origin;
vec3 direction;

// Reads the i-th ray of the tile, and says whether it counts.
bool next_ray(int i) {
  ivec2 at = ivec2(gl_FragCoord.xy) * tile + ivec2(i % tile, i / tile);
  vec4 o = texelFetch(origins, at, 0);
  vec4 d = texelFetch(directions, at, 0);
  float enter;
  float leave;
  box(vec3(-cube), vec3(cube), o.xyz, d.xyz, o.w, d.w, 1 + 1.0f / 1048576, enter, leave);
  origin = o.xyz;
  direction = unit_vector(d.xyz);
  return !(enter > leave);
}

void main() {
  vec3 apex = vec3(0);
  vec3 axis = vec3(0);
  float cosine = 2;
  float sine = 0;
  int count = tile * tile;
  int first = 0;
  while (first < count && !next_ray(first)) ++first;
  if (first < count) {
    apex = origin;
    axis = direction;
    cone_opened(0, cosine, sine);
    for (int i = first + 1; i < count; ++i) {
      if (!next_ray(i)) continue;
      cone_extended(axis, cosine, sine, direction, axis, cosine, sine);
      apex = cone_translated(apex, axis, cosine, sine, origin);
    }
    float tangent = sine / cosine;
    float widest = tangent;
    float setback = -REAL_MAX;
    for (int i = first; i < count && cosine >= 0; ++i) {
      if (!next_ray(i)) continue;
      widest = larger(widest, cone_tangent(axis, direction));
      setback = larger(setback, cone_setback(apex, axis, tangent, origin));
    }
    cone_settled(apex, axis, cosine, widest, setback, apex, cosine, sine);
  }
  apex_cosine = vec4(apex, cosine);
  axis_sine = vec4(axis, sine);
}
