#include "cpu/reference/root.h"

namespace rayengine::reference {
namespace {

/// The sign of x + y r, where r is the root of `square` > 0.
int sign_of_sum(const Exact& x, const Exact& y, const Exact& square) {
  if (x.sign() * y.sign() >= 0) return x.sign() != 0 ? x.sign() : y.sign();
  return (x * x - y * y * square).sign() * x.sign();
}

Exact discriminant(const Root& root) { return root.b * root.b - root.a * root.c; }

Exact negated_if(bool negate, const Exact& x) { return negate ? Exact() - x : x; }

/// The sign of s - t, neither of which is linear. Times a a', their difference is x + y r + z r', with the roots r and
/// r' of the discriminants D and D'. Where x is against y r + z r' their squares decide, whose difference is x^2 - y^2
/// D - z^2 D' - 2 y z r r'.
int compare_quadratic(const Root& s, const Root& t) {
  const Exact x = t.b * s.a - s.b * t.a, y = negated_if(!s.plus, t.a), z = negated_if(t.plus, s.a);
  const Exact d = discriminant(s), e = discriminant(t), product = d * e;
  const int both = s.a.sign() * t.a.sign();
  const int roots = sign_of_sum(y * d, z, product);  // times r
  if (x.sign() * roots >= 0) return (x.sign() != 0 ? x.sign() : roots) * both;
  const Exact yz = y * z;
  return sign_of_sum(x * x - y * y * d - z * z * e, Exact() - (yz + yz), product) * x.sign() * both;
}

}  // namespace

Root fraction(const Exact& n, const Exact& d) { return {Exact(), d, Exact() - (n + n)}; }

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

int compare(const Root& s, const Root& t) {
  if (t.a.sign() == 0) return compare(s, Exact() - t.c, t.b + t.b);
  if (s.a.sign() == 0) return -compare(t, Exact() - s.c, s.b + s.b);
  return compare_quadratic(s, t);
}

bool is_moderate(const Root& root) {
  // Products of eight coefficients are formed, and each may have 113 bits below its last.
  return root.a.within(1000) && root.b.within(1000) && root.c.within(1000);
}

}  // namespace rayengine::reference
