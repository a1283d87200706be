// Roots of quadratics compared without rounding, against long doubles that see a difference wherever there is one.

#include "cpu/reference/root.h"

#include <gtest/gtest.h>

#include <cmath>

namespace rayengine::reference {
namespace {

struct Known {
  Root exact;
  long double value;
};

/// All roots of forms with small whole coefficients: equal ones, of forms that are multiples of each other and not, are
/// many, and others at least 1e-3 apart.
std::vector<Known> small_roots() {
  std::vector<Known> roots;
  for (int a = -3; a <= 3; ++a)
    for (int b = -3; b <= 3; ++b)
      for (int c = -3; c <= 3; ++c) {
        const int discriminant = b * b - a * c;
        if (discriminant <= 0) continue;
        for (const bool plus : {false, true}) {
          const long double h = std::sqrt(static_cast<long double>(discriminant));
          const long double value = a != 0 ? (plus ? -b + h : -b - h) / a : -c / (2.0L * b);
          roots.push_back({{Exact(a), Exact(b), Exact(c), plus}, value});
        }
      }
  return roots;
}

int sign(long double x) { return std::abs(x) < 1e-9L ? 0 : x < 0 ? -1 : 1; }

TEST(ReferenceRoot, ComparesAnyTwo) {
  const std::vector<Known> roots = small_roots();
  std::size_t equal = 0;
  for (const Known& s : roots)
    for (const Known& t : roots) {
      const int order = sign(s.value - t.value);
      ASSERT_EQ(compare(s.exact, t.exact), order)
          << static_cast<double>(s.value) << " " << static_cast<double>(t.value);
      equal += order == 0;
    }
  EXPECT_GT(equal, 2 * roots.size());
}

TEST(ReferenceRoot, TellsApartWhatNoQuadDoes) {
  // The roots of t^2 = 2 and of t^2 = 2 + 2^-300, whose quads are the same.
  const Exact one(1), none, two(2), more = two + Exact(0x1p-300);
  const Root s{one, none, Exact() - two, true}, t{one, none, Exact() - more, true};
  EXPECT_EQ(compare(s, t), -1);
  EXPECT_EQ(compare(t, s), 1);
  EXPECT_EQ(compare(t, t), 0);
  EXPECT_TRUE(is_moderate(t));
  EXPECT_FALSE(is_moderate(Root{Exact(0x1p-1001), none, one, true}));
}

}  // namespace
}  // namespace rayengine::reference
