// Any ray, a point of a vertex buffer, through the grid; transform feedback takes the answer. After grid.glsl.
layout(location = 0) in uvec4 from;  // the bits of the origin, and of tmin
layout(location = 1) in uvec4 to;    // of the direction, and of tmax
layout(location = 2) in uvec4 rest;  // x: a hit at tmin counts if its rank is above this
layout(location = 19) uniform bool any_hit;
layout(xfb_buffer = 0, xfb_offset = 0, xfb_stride = 8) flat out uvec2 answer;  // the bits of t, and rank; or none

void main() {
  origin = uintBitsToFloat(from.xyz);
  tmin = uintBitsToFloat(from.w);
  direction = uintBitsToFloat(to.xyz);
  tmax = uintBitsToFloat(to.w);
  floor_rank = rest.x;
  best_t = REAL_MAX;
  best_rank = none;
  any_will_do = any_hit;
  find();
  answer = uvec2(floatBitsToUint(best_t), best_rank);
}
