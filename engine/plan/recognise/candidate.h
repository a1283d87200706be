#pragma once

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vector_relational.hpp>
#include <numbers>

#include "accel/quadric.h"
#include "engine/plan/recognise/regions.h"

namespace rayengine::surfaces {

/// A clipped quadric that may stand for a region: a unit primitive, whole (sphere), between two heights (sphere,
/// cylinder, cone, paraboloid, hyperboloids), with its own rim (disk), or over a rectangle about its origin (plane,
/// saddle).
struct Candidate {
  QuadricType type = QuadricType::sphere;
  bool inward = false;  ///< the mesh has its front where the unit primitive has its inside
  bool capped = false;
  Affine to_world;                       ///< its axes stay at right angles, and right-handed
  std::array<double, 2> clip{-1, 1};     ///< heights in object space, where the type has them
  double half_angle = std::numbers::pi;  ///< of a cylinder: how far it reaches round its axis from x, either way
  glm::dvec2 half{1};                    ///< half the rectangle's sides in object space, where the type has one
};

/// Lengths of the images of the axes.
inline glm::dvec3 lengths(const Affine& map) {
  return {glm::length(map.linear[0]), glm::length(map.linear[1]), glm::length(map.linear[2])};
}

/// Whether the map's inverse and the volumes that it makes are numbers.
inline bool is_invertible(const Affine& map) {
  constexpr double smallest = 1e-90;
  const glm::dvec3 l = lengths(map);
  const glm::bvec3 within = glm::lessThan(glm::dvec3(smallest), l), below = glm::lessThan(l, glm::dvec3(1 / smallest));
  return glm::all(within) && glm::all(below) && std::isfinite(map.origin.x + map.origin.y + map.origin.z);
}

inline bool is_whole_sphere(const Candidate& c) {
  return c.type == QuadricType::sphere && c.clip[0] <= -1 && c.clip[1] >= 1;
}
inline bool is_whole_turn(const Candidate& c) { return c.half_angle >= std::numbers::pi; }

/// Some triangles of a mesh.
struct Patch {
  const Topology& mesh;
  std::span<const std::uint32_t> triangles;

  glm::dvec3 corner(std::uint32_t triangle, int k) const { return mesh.positions[mesh.triangles[triangle][k]]; }
};

/// A patch that is one of several regions, so that it has an outline.
struct Region : Patch {
  const Regions& regions;
  std::uint32_t id;

  bool is_outline(std::uint32_t half_edge) const {
    const std::uint32_t twin = mesh.twins[half_edge];
    return twin == no_id || regions.of(twin / 3) != id;
  }
};

}  // namespace rayengine::surfaces
