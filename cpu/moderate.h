#pragma once

#include <cmath>

#include "accel/ray.h"
#include "accel/transform.h"

namespace rayengine {

/// Error bounds in double hold where no product over- or underflows. Up to here, and for what is not zero by nature
/// from the inverse on, none does; whatever is beyond is for exact arithmetic.
inline constexpr double moderate_limit = 0x1p100;

inline double largest_component(const glm::dvec3& v) {
  return std::fmax(std::fmax(std::abs(v.x), std::abs(v.y)), std::abs(v.z));
}

inline bool is_moderate(double size) { return size >= 1 / moderate_limit && size <= moderate_limit; }

inline bool is_moderate(const Ray& ray) {
  return largest_component(ray.origin) <= moderate_limit && is_moderate(largest_component(ray.direction));
}

/// The largest row sum of a matrix's magnitudes: no component of its product with v is larger than that times v's
/// largest.
inline double norm_of(const glm::dmat3& m) {
  return largest_component(glm::abs(m[0]) + glm::abs(m[1]) + glm::abs(m[2]));
}

}  // namespace rayengine
