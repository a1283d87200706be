// The ray and the nearest hit in 16-bit halves. Source: Wood, McCane, King, "Ray Tracing Arbitrary Objects on the GPU" (2004),
// figures 4 and 5: r, g, b each hold a component of a position and one of a normal (here also of an origin and a direction);
// a is the object's number in 32 bits.
layout(binding = 0) uniform usampler2D rays;  // r, g, b: origin and direction; a: tmin and tmax
layout(binding = 4) uniform usampler2D hits;  // r, g, b: position and normal; a: rank

const uint none = 0xFFFFFFFFu;

void unpack(uvec3 packed_halves, out vec3 low, out vec3 high) {
  vec2 x = unpackHalf2x16(packed_halves.x);
  vec2 y = unpackHalf2x16(packed_halves.y);
  vec2 z = unpackHalf2x16(packed_halves.z);
  low = vec3(x.x, y.x, z.x);
  high = vec3(x.y, y.y, z.y);
}
