#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>

namespace rayengine {

/// What may be wrong with a mesh, by its indices; none of it keeps the mesh from being traced.
struct MeshDefects {
  std::uint64_t without_area = 0;        ///< triangles
  std::uint64_t duplicates = 0;          ///< triangles with the same three vertices as an earlier one
  std::uint64_t boundary_edges = 0;      ///< edges of one triangle
  std::uint64_t non_manifold_edges = 0;  ///< edges of more than two triangles
};

MeshDefects find_defects(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles);

/// "6 triangles of no area, 14 boundary edges", or nothing.
std::string to_string(const MeshDefects& defects);

}  // namespace rayengine
