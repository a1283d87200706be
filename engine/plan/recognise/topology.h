#pragma once

#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "accel/ray.h"

namespace rayengine::surfaces {

/// A mesh's triangles and how they meet. Half-edge 3 t + k runs from corner k of triangle t to its next corner.
struct Topology {
  std::span<const glm::dvec3> positions;
  std::span<const glm::uvec3> triangles;
  /// Of each half-edge: the one that runs the other way along the same edge, or no_id unless there is exactly one, and
  /// none that runs the same way.
  std::vector<std::uint32_t> twins;
  std::vector<glm::dvec3> normals;  ///< of unit length, one a triangle, NaN where it has no area; or none at all

  std::uint32_t from(std::uint32_t half_edge) const { return triangles[half_edge / 3][half_edge % 3]; }
  std::uint32_t to(std::uint32_t half_edge) const { return triangles[half_edge / 3][(half_edge % 3 + 1) % 3]; }
};

/// Of unit length; NaN where there is no area.
inline glm::dvec3 normal(const Topology& mesh, const glm::uvec3& t) {
  const glm::dvec3 a = mesh.positions[t.x];
  const glm::dvec3 n = glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a);
  return n / glm::length(n);
}

/// Of each of the `among` triangles' half-edges its twin; others get none.
std::vector<std::uint32_t> find_twins(std::span<const glm::uvec3> triangles, std::span<const std::uint32_t> among,
                                      std::size_t vertices);

/// The triangles, where those `among` them have one vertex, the lowest of theirs, for all corners at one position.
std::vector<glm::uvec3> weld(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles,
                             std::span<const std::uint32_t> among);

}  // namespace rayengine::surfaces
