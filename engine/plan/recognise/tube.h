#pragma once

#include <vector>

#include "engine/plan/recognise/cloud.h"

namespace rayengine::surfaces {

/// In a cloud's space: all points whose distance from the axis is radius + slope * height above `base`.
struct Tube {
  glm::dvec3 base, axis;
  double radius, slope;

  double height(const glm::dvec3& p) const { return glm::dot(p - base, axis); }
  double off(const glm::dvec3& p) const { return glm::length(glm::cross(p - base, axis)) - radius - slope * height(p); }
};

/// A tube and how far off it is, at most, from the corners that it was fitted to; in the cloud's space.
struct FittedTube {
  Tube tube;
  double noise;
};

/// The cylinder through a patch's corners.
std::optional<FittedTube> fit_cylinder(const Patch& patch, const Cloud& cloud);

/// The cylinder, the cones that widen along the axis and against it: as many as there are.
std::vector<FittedTube> fit_cylinder_and_cones(const Patch& patch, const Cloud& cloud);

}  // namespace rayengine::surfaces
