#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace rayengine::surfaces {

/// A sphere or ellipsoid: its centre and half its lengths.
struct Round {
  glm::dvec3 center, half;
};

/// Of each, whether another's centre and half lengths are within `distance` of its own. At most some 2^16 of them may
/// be within a few `distance` of one point for this to be quick.
std::vector<bool> coincident(std::span<const Round> rounds, double distance);

}  // namespace rayengine::surfaces
