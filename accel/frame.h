#pragma once

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace rayengine {

/// Right-handed and at right angles, with the unit vector `axis` as the third column.
inline glm::dmat3 frame_about(const glm::dvec3& axis) {
  const glm::dvec3 size = glm::abs(axis);
  glm::dvec3 away(0);
  away[size.x <= size.y ? (size.x <= size.z ? 0 : 2) : (size.y <= size.z ? 1 : 2)] = 1;
  const glm::dvec3 u = glm::normalize(glm::cross(away, axis));
  return {u, glm::cross(axis, u), axis};
}

}  // namespace rayengine
