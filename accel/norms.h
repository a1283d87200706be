#pragma once

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

// Sizes of vectors and matrices that error bounds are told in. None takes a root, nor squares what might overflow.
namespace rayengine {

inline double largest_component(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// Not below the length.
inline double sum_abs(const glm::dvec3& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

/// The largest row sum of a matrix's magnitudes: no component of its product with v is larger than that times v's
/// largest.
inline double norm_of(const glm::dmat3& m) {
  return largest_component(glm::abs(m[0]) + glm::abs(m[1]) + glm::abs(m[2]));
}

}  // namespace rayengine
