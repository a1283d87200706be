#pragma once

// The intersection kernels as C++. Each .glsl file below is written once, in the subset that GLSL and this header
// share, and becomes a set of templates over REAL: float, double, or a vector of lanes of either (GCC vector
// extensions), whose comparisons give masks. Everything is inlined, so that code built for one instruction set never
// leaks into another.

#include <cmath>
#include <limits>
#include <type_traits>

namespace rayengine::kernels {

template <class REAL>
struct Vec3 {
  REAL x, y, z;
  Vec3() = default;
  [[gnu::always_inline]] Vec3(REAL x, REAL y, REAL z) : x(x), y(y), z(z) {}
};

template <class REAL>
inline constexpr bool is_lanes = !std::is_arithmetic_v<REAL>;

template <class REAL>
using Mask = decltype(REAL{} < REAL{});

template <class REAL>
struct Scalar {
  using type = REAL;
};
template <class REAL>
requires is_lanes<REAL>
struct Scalar<REAL> {
  using type = std::remove_cvref_t<decltype(REAL{}[0])>;
};

#define KERNEL          \
  template <class REAL> \
  [[gnu::always_inline]] inline
#define VEC3 Vec3<REAL>
#define BOOL Mask<REAL>
#define OUT(T) T&
#define REAL_MAX (REAL{} + std::numeric_limits<typename Scalar<REAL>::type>::max())
#define ROUNDINGS(n) (n * std::numeric_limits<typename Scalar<REAL>::type>::epsilon() / 2)

template <class MASK>
[[gnu::always_inline]] inline MASK both(MASK a, MASK b) {
  return a & b;
}
template <class MASK>
[[gnu::always_inline]] inline MASK either(MASK a, MASK b) {
  return a | b;
}
template <class MASK, class REAL>
[[gnu::always_inline]] inline REAL pick(MASK condition, REAL yes, REAL no) {
  return condition ? yes : no;
}
KERNEL REAL magnitude(REAL a) { return a < 0 ? -a : a; }
KERNEL REAL smaller(REAL a, REAL b) { return a < b ? a : b; }
KERNEL REAL larger(REAL a, REAL b) { return a > b ? a : b; }
KERNEL REAL whole(REAL a) { return std::floor(a); }
KERNEL REAL root(REAL a) {
  if constexpr (is_lanes<REAL>) {
    for (unsigned i = 0; i < sizeof(REAL) / sizeof(a[0]); ++i) a[i] = __builtin_sqrt(a[i]);
    return a;
  } else {
    return std::sqrt(a);
  }
}

KERNEL REAL power(REAL a, REAL b) {
  if constexpr (is_lanes<REAL>) {
    for (unsigned i = 0; i < sizeof(REAL) / sizeof(a[0]); ++i) a[i] = std::pow(a[i], b[i]);
    return a;
  } else {
    return std::pow(a, b);
  }
}

#include "accel/kernels/box.glsl"
#include "accel/kernels/grid.glsl"
#include "accel/kernels/highlight.glsl"
#include "accel/kernels/quadric.glsl"
#include "accel/kernels/ray_cone.glsl"
#include "accel/kernels/triangle.glsl"
#include "accel/kernels/uncertainty.glsl"

#undef KERNEL
#undef VEC3
#undef BOOL
#undef OUT
#undef REAL_MAX
#undef ROUNDINGS

}  // namespace rayengine::kernels
