#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "accel/quadric.h"

namespace rayengine {

struct RoundSphere {
  glm::dvec3 center;
  double radius;
};

/// A quadric as the sphere that other tools know: round and whole. Nothing when it is another surface.
std::optional<RoundSphere> round_sphere(const Quadric& quadric);

}  // namespace rayengine
