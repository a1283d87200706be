#include "cpu/reference/root.h"

namespace rayengine::reference {

int compare(const Root& root, const Exact& n, const Exact& d) {
  const auto& [a, b, c, plus] = root;
  const Exact twice_b = b + b;
  if (a.sign() == 0) return -(c * d + n * twice_b).sign() * b.sign() * d.sign();
  // Of the parabola that opens upwards: below 0 lie the points between the roots, and its axis parts the others.
  const bool upper = plus == (a.sign() > 0);
  const int value = (a * n * n + twice_b * n * d + c * d * d).sign() * a.sign();
  const bool beyond_axis = (a * n + b * d).sign() * d.sign() * a.sign() > 0;
  if (value < 0) return upper ? 1 : -1;
  if (value == 0 && beyond_axis == upper) return 0;
  return beyond_axis ? -1 : 1;
}

}  // namespace rayengine::reference
