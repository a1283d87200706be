#pragma once

#include <optional>

#include "engine/plan/model.h"

namespace rayengine {

/// A coarser mesh within `tolerance` of a mesh object, in units of the scene: no point of either surface is farther
/// than that from the other. Nothing where less than half of the triangles would go.
///
/// Vertices that share a cell of a lattice become one, but for those that would be moved by more than the tolerance,
/// and triangles left with less than three corners go. The bound needs no search: each point of a triangle moves no
/// farther than its corners do, and what is dropped must have become an edge or a corner of what is left. Takes a few
/// passes over vertices and triangles. Source of the idea: Rossignac, Borrel, "Multi-resolution 3D approximations for
/// rendering complex scenes" (1993).
/// Throws Error on a tolerance that is not finite or not above 0.
std::optional<CoarserMesh> coarsen(const Geometry& geometry, std::uint32_t object, double tolerance);

}  // namespace rayengine
