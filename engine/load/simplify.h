#pragma once

#include "engine/plan/model.h"

namespace rayengine {

/// What OpenMesh decimates in a second or so.
inline constexpr std::size_t default_most_decimated = 20'000;

/// A coarser mesh within `tolerance` of `mesh`, in its units: no point of either surface is farther than that from the
/// other. Its vertices are some of those of `mesh`, with their normals, bit for bit. Vertices are clustered where that
/// drops half of the triangles or more; then OpenMesh's decimater drops what it can, unless more than `most_decimated`
/// triangles are left. The mesh itself, with distance 0, where neither finds anything. Triangles without area count as
/// no surface. Throws Error unless the tolerance is finite and above 0, and where the mesh has positions that are not
/// finite or indices out of range.
CoarserMesh simplify(const Mesh& mesh, double tolerance, std::size_t most_decimated = default_most_decimated);

}  // namespace rayengine
