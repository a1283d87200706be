#pragma once

#include <cstdint>
#include <vector>

#include "accel/geometry.h"

namespace rayengine {

/// A region of a mesh that an exact quadric stands for.
struct RecognisedQuadric {
  QuadricShape shape;
  Affine to_world;                       ///< from the shape's object space to the mesh's space
  std::vector<std::uint32_t> triangles;  ///< what it replaces, ascending
  /// A proven bound on the two-sided (Hausdorff) distance between the triangles and the clipped quadric, in the mesh's
  /// units; at most the tolerance.
  double residual = 0;
};

struct Recognition {
  std::vector<RecognisedQuadric> quadrics;  ///< by their first triangle, ascending
  std::vector<std::uint32_t> rest;          ///< triangles that stay, ascending
};

/// Fewer triangles than this stay what they are: a quadric takes the memory of three to four triangles, and a callback
/// instead of a native test, so that below this nothing is gained.
inline constexpr std::size_t fewest_triangles = 8;

/// Where to look: at whole connected pieces, which are balls and ellipsoids and found faster than a BVH is built, or at
/// the parts of pieces, too, which takes some twenty times as long.
enum class Pieces { whole, parts };

/// Finds regions of a mesh that are tessellated quadrics: see docs/plan.md. The outside of a quadric is where the mesh
/// has its front. `tolerance` is in the mesh's units. The same result whatever the number of threads. Where in doubt
/// the triangles stay. Throws Error when the tolerance is not finite and above zero, on positions that are not finite,
/// and on indices out of range.
Recognition recognise(const Mesh& mesh, double tolerance, Pieces pieces = Pieces::parts);

}  // namespace rayengine
