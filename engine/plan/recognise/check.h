#pragma once

#include <optional>

#include "engine/plan/recognise/candidate.h"

namespace rayengine::surfaces {

/// A bound on the two-sided distance between a region and the clipped quadric of a candidate, which the region must
/// cover once, or nothing where there is none up to the tolerance.
///
/// Lines through the quadric, its fibres, are followed from the triangles to the quadric: from the centre through a
/// sphere, at right angles to the axis and through it for tubes, along the axis for domes and plates. Bounded are how
/// far the triangles are from the quadric along fibres, and how far the region's outline is from the quadric's. Every
/// triangle must face along its fibres, so that one fibre that meets the region once, away from the outline, proves
/// that they all do: the number can change at the outline only.
std::optional<double> proven_residual(const Region& region, const Candidate& candidate, double tolerance);

}  // namespace rayengine::surfaces
