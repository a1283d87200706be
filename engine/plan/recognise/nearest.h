#pragma once

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace rayengine::surfaces {

/// The point of an edge that is nearest to the origin.
inline glm::dvec3 nearest_to_origin(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 along = b - a;
  const double size = glm::dot(along, along);
  return size > 0 ? a + std::clamp(-glm::dot(a, along) / size, 0., 1.) * along : a;
}

}  // namespace rayengine::surfaces
