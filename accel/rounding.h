#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace rayengine {

/// The next double above; infinity and NaN stay what they are.
inline double next_above(double a) {
  if (!(a < std::numeric_limits<double>::infinity())) return a;
  if (a == 0) return std::numeric_limits<double>::denorm_min();
  const auto bits = std::bit_cast<std::int64_t>(a);
  return std::bit_cast<double>(a > 0 ? bits + 1 : bits - 1);
}

inline float next_above(float a) {
  if (!(a < std::numeric_limits<float>::infinity())) return a;
  if (a == 0) return std::numeric_limits<float>::denorm_min();
  const auto bits = std::bit_cast<std::int32_t>(a);
  return std::bit_cast<float>(a > 0 ? bits + 1 : bits - 1);
}

/// The smallest float that is not below `a`, and the largest that is not above it.
inline float float_above(double a) {
  const float f = static_cast<float>(a);
  return static_cast<double>(f) < a ? next_above(f) : f;
}
inline float float_below(double a) { return -float_above(-a); }

}  // namespace rayengine
