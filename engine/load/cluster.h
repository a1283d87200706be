#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace rayengine {

/// Merges vertices that share a cell of a grid and face the same way, some limits wide, and drops the triangles that
/// this leaves without area. Both directions of the Hausdorff distance are then proven to be at most `limit`; cells
/// where the proof fails are halved, and at last given up, vertex by vertex. Gives triangles of some of the same
/// vertices; the same ones where nothing could be merged. Linear in the mesh but for sorting, and parallel. Source of
/// the idea: Rossignac, Borrel, "Multi-resolution 3D approximations for rendering complex scenes" (1993).
std::vector<glm::uvec3> cluster(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles,
                                double limit);

}  // namespace rayengine
