#pragma once

#include <optional>

#include "engine/plan/recognise/candidate.h"

// Guesses of what a region may be, from its corners and its triangles' normals. Whether they hold is for
// proven_residual to say.
namespace rayengine::surfaces {

/// The sphere through a region's corners, by linear least squares.
std::optional<Candidate> fit_sphere(const Region& region);

}  // namespace rayengine::surfaces
