// Three texels a triangle: its corners, and in the first one's w its rank. After the kernel, and consider().
layout(binding = 6) uniform usamplerBuffer triangles;

// Of unit length, on the side from which the corners run counter-clockwise.
vec3 triangle_normal(int i) {
  vec3 a = uintBitsToFloat(texelFetch(triangles, i).xyz);
  vec3 b = uintBitsToFloat(texelFetch(triangles, i + 1).xyz);
  vec3 c = uintBitsToFloat(texelFetch(triangles, i + 2).xyz);
  return normalize(cross(b - a, c - a));
}

// Tests the triangle whose texels begin at i, and says whether a hit was kept.
bool test_triangle(int i) {
  uvec4 a = texelFetch(triangles, i);
  uvec4 b = texelFetch(triangles, i + 1);
  uvec4 c = texelFetch(triangles, i + 2);
  float t;
  float u;
  float v;
  bool hit;
  triangle(origin, direction, uintBitsToFloat(a.xyz), uintBitsToFloat(b.xyz), uintBitsToFloat(c.xyz), t, u, v, hit);
  return hit && consider(t, a.w);
}
