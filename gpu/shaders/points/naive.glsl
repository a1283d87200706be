// Every triangle of the scene, in no structure. After triangle.glsl.
layout(location = 18) uniform int triangle_count;

int nearest;

void find() {
  for (int i = 0; i < 3 * triangle_count && !enough(); i += 3)
    if (test_triangle(i)) nearest = i;
}
