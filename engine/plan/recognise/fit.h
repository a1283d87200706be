#pragma once

#include <optional>

#include "engine/plan/recognise/candidate.h"

// Guesses of what a region may be, from its corners and its triangles' normals. Whether they hold is for
// proven_residual to say.
namespace rayengine::surfaces {

/// The sphere through a region's corners, by linear least squares.
std::optional<Candidate> fit_sphere(const Region& region);

/// The part of a sphere between two parallel planes, or beyond one, that a region may be.
std::optional<Candidate> fit_zone(const Region& region);

/// The disk and the rectangle that a flat region's outline may be.
std::vector<Candidate> fit_plates(const Region& region);

/// The cylinder and the cone that a region about an axis may be, the likelier first.
std::vector<Candidate> fit_tubes(const Region& region);

/// The quadric of any type through a region's corners, if it has one of the unit primitives' forms.
std::optional<Candidate> fit_quadric(const Region& region);

/// Whether most of a region's area has its front where the unit primitive has its inside.
bool faces_inward(const Region& region, const Candidate& candidate);

}  // namespace rayengine::surfaces
