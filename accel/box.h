#pragma once

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "accel/ray.h"
#include "accel/transform.h"

namespace rayengine {

/// An axis-aligned box; empty until something is added. Sides may be infinite.
struct Box {
  glm::dvec3 lower{infinity};
  glm::dvec3 upper{-infinity};

  bool empty() const { return !(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z); }
  bool finite() const { return !empty() && extent() < infinity; }
  void add(const glm::dvec3& p) { lower = glm::min(lower, p), upper = glm::max(upper, p); }
  void add(const Box& b) { lower = glm::min(lower, b.lower), upper = glm::max(upper, b.upper); }
  glm::dvec3 center() const { return 0.5 * (lower + upper); }
  glm::dvec3 size() const { return upper - lower; }

  /// From a point; 0 within.
  double squared_distance(const glm::dvec3& p) const {
    const glm::dvec3 d = glm::max(glm::max(lower - p, p - upper), glm::dvec3(0));
    return glm::dot(d, d);
  }

  /// The largest absolute coordinate.
  double extent() const {
    const glm::dvec3 e = glm::max(glm::abs(lower), glm::abs(upper));
    return std::max({e.x, e.y, e.z});
  }
};

/// For what may be infinite: an axis that does not matter adds nothing.
inline double product_or_zero(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }

/// The box of a box that is taken through the map.
inline Box transformed(const Box& box, const Affine& map) {
  Box result{map.origin, map.origin};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      const double a = product_or_zero(map.linear[column][row], box.lower[column]);
      const double b = product_or_zero(map.linear[column][row], box.upper[column]);
      result.lower[row] += std::min(a, b);
      result.upper[row] += std::max(a, b);
    }
  return result;
}

}  // namespace rayengine
