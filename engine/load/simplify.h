#pragma once

#include "accel/geometry.h"

namespace rayengine {

struct Simplified {
  Mesh mesh;
  double distance = 0;  ///< a bound on the two-sided Hausdorff distance to the original, at most the tolerance
};

/// What the two stages of simplify cost: seconds of processor time for each triangle that they are given (measured, see
/// docs/plan.md).
inline constexpr double clustering_seconds = 0.9e-6, decimation_seconds = 1e-4;

/// What OpenMesh decimates in a second or so.
inline constexpr std::size_t default_most_decimated = 20'000;

/// A coarser mesh within `tolerance` of `mesh`, in its units: no point of either surface is farther than that from the
/// other. Its vertices are some of those of `mesh`, with their normals, bit for bit. Vertices are clustered where that
/// drops half of the triangles or more; then OpenMesh's decimater drops what it can, unless more than `most_decimated`
/// triangles are left. The mesh itself, with distance 0, where neither finds anything. Triangles without area count as
/// no surface. Throws Error unless the tolerance is finite and above 0, and where the mesh has positions that are not
/// finite or indices out of range.
Simplified simplify(const Mesh& mesh, double tolerance, std::size_t most_decimated = default_most_decimated);

}  // namespace rayengine
