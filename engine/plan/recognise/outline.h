#pragma once

#include <optional>

#include "engine/plan/recognise/candidate.h"

namespace rayengine::surfaces {

/// How a region's outline differs from that of a clipped quadric.
struct Outline {
  double vertices = 0;  ///< how far the outline's vertices are from it, in object space, or in radians round the axis
  double distance = 0;  ///< bound on what that adds to the distance of the surfaces, in the mesh's units
  glm::dvec3 lower{-infinity}, upper{infinity};  ///< object space: no outline is between these
  double half_angle = infinity;                  ///< nor within this angle from x about the axis
  double radius = infinity;                      ///< nor within this distance of the axis

  /// Whether a point is inside, away from the outline.
  bool contains(const glm::dvec3& p) const {
    return p.x > lower.x && p.y > lower.y && p.z > lower.z && p.x < upper.x && p.y < upper.y && p.z < upper.z &&
           std::hypot(p.x, p.y) < radius && std::abs(std::atan2(p.y, p.x)) < half_angle;
  }
};

/// Nothing where the outline is another than the candidate's: for a whole sphere none, for a tube one line round each
/// end, for a sector of one a line along its sides, for a dome or disk one round the rim, for a rectangle one along its
/// sides. How many lines, and which way they run, does not matter here: whoever asks counts how often the region covers
/// what is inside.
std::optional<Outline> compare_outline(const Region& region, const Candidate& candidate, const WorldToObject& map);

}  // namespace rayengine::surfaces
