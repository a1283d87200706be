// Every triangle of the scene, in no structure. After triangle.glsl.
layout(location = 3) uniform int triangle_count;

// The first texel of the primitive hit, for the ray of consider.glsl: the nearest, or any where that will do.
int intersect(bool any_will_do) {
  int nearest = -1;
  for (int i = 0; i < 3 * triangle_count; i += 3) {
    if (!test_triangle(i)) continue;
    nearest = i;
    if (any_will_do) break;
  }
  return nearest;
}
