#pragma once

#include <vector>

// Declared here because clang has no <quadmath.h>; both come from libquadmath.
extern "C" __float128 sqrtq(__float128);
extern "C" __float128 fmaq(__float128, __float128, __float128);

namespace rayengine::reference {

using quad = __float128;

inline int sign(quad x) { return x < 0 ? -1 : x > 0; }

/// A number without rounding: a sum of quads that do not overlap, smallest first, zeros left out; empty is zero.
/// Sums and products are exact as long as quads do not underflow, which doubles cannot make them do.
/// Source of the method: Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates"
/// (Discrete & Computational Geometry 18, 1997), sections 2.2 to 2.8.
class Exact {
 public:
  Exact() = default;
  explicit Exact(double x) { add(x); }

  int sign() const { return terms_.empty() ? 0 : terms_.back() < 0 ? -1 : 1; }
  /// Whether all of its terms are from 2^-exponent to 2^exponent.
  bool within(int exponent) const;
  /// The value rounded to a quad, within two units in its last place.
  quad rounded() const;

  friend Exact operator+(const Exact& a, const Exact& b);
  friend Exact operator-(const Exact& a, const Exact& b);
  friend Exact operator*(const Exact& a, const Exact& b);

 private:
  void add(quad x);

  std::vector<quad> terms_;
};

}  // namespace rayengine::reference
