// Three texels a triangle: its corners, and in the first one's w its rank.
layout(binding = 6) uniform usamplerBuffer triangles;

#ifdef HALF
int nearest;

vec3 corner(int i) { return uintBitsToFloat(texelFetch(triangles, nearest + i).xyz); }

vec3 best_normal() {
  vec3 a = corner(0);
  return normalize(cross(corner(1) - a, corner(2) - a));
}
#endif

void main() {
  uvec2 range = begin();
  int stop = 3 * int(range.x + range.y);
  for (int i = 3 * int(range.x); i < stop && !enough(); i += 3) {
    uvec4 a = texelFetch(triangles, i);
    uvec4 b = texelFetch(triangles, i + 1);
    uvec4 c = texelFetch(triangles, i + 2);
    float t;
    float u;
    float v;
    bool hit;
    triangle(origin, direction, uintBitsToFloat(a.xyz), uintBitsToFloat(b.xyz), uintBitsToFloat(c.xyz), t, u, v, hit);
    if (!hit) continue;
    bool kept = consider(t, a.w);
#ifdef HALF
    if (kept) nearest = i;
#endif
  }
  end();
}
