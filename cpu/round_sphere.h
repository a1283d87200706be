#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "accel/quadric.h"

namespace rayengine {

struct RoundSphere {
  glm::dvec3 center;
  double radius;
};

/// A quadric as the sphere that other tools know: round and whole. Nothing when it is another surface.
std::optional<RoundSphere> round_sphere(const Quadric& quadric);

struct SphereMesh {
  std::vector<glm::dvec3> positions;
  std::vector<glm::uvec3> triangles;
};

/// The unit sphere as 512 triangles: an octahedron, each face cut in four three times.
SphereMesh unit_sphere_mesh();

}  // namespace rayengine
