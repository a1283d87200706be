#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace rayengine {

struct Coarser {
  std::vector<glm::uvec3> triangles;  ///< of some of the same vertices
  double distance = 0;                ///< a bound on the two-sided Hausdorff distance, at most the limit
};

/// Collapses edges by OpenMesh's decimater, in the order of their quadric error, and checks what came of it against
/// `limit` both ways: where a triangle strays, its vertices are kept and all is done anew, with more care. Faces that a
/// half-edge mesh cannot hold stay, with their neighbours' edges. The triangles as they are where no try passes the
/// check. Best where positions are of the order of the limit. Source: Garland, Heckbert, "Surface Simplification Using
/// Quadric Error Metrics" (1997).
Coarser decimate(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles, double limit);

}  // namespace rayengine
