// A range of triangles against the ray of this fragment.
#ifdef HALF
int nearest;

vec3 best_normal() { return triangle_normal(nearest); }
#endif

void main() {
  uvec2 range = begin();
  int stop = 3 * int(range.x + range.y);
  for (int i = 3 * int(range.x); i < stop && !enough(); i += 3) {
    bool kept = test_triangle(i);
#ifdef HALF
    if (kept) nearest = i;
#endif
  }
  end();
}
