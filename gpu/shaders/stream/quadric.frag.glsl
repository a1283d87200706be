// A range of quadrics of one type against the ray of this fragment. Defined from outside: TEST(i) and NORMAL(i, position, rank).
#ifdef HALF
int nearest;

vec3 best_normal() { return NORMAL(nearest, best_position(), best_rank); }
#endif

void main() {
  uvec2 range = begin();
  int stop = 4 * int(range.x + range.y);
  for (int i = 4 * int(range.x); i < stop && !enough(); i += 4) {
    bool kept = TEST(i);
#ifdef HALF
    if (kept) nearest = i;
#endif
  }
  end();
}
