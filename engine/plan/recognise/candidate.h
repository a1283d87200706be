#pragma once

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "accel/quadric.h"
#include "engine/plan/recognise/regions.h"

namespace rayengine::surfaces {

/// A clipped quadric that may stand for a region: a unit primitive, whole (sphere), between two heights (cylinder,
/// cone, paraboloid, hyperboloids), with its own rim (disk), or over a rectangle about its origin (plane, saddle).
struct Candidate {
  QuadricType type = QuadricType::sphere;
  bool inward = false;           ///< the mesh has its front where the unit primitive has its inside
  Affine to_world;               ///< its axes stay at right angles, and right-handed
  std::array<double, 2> clip{};  ///< heights in object space, where the type has them
  glm::dvec2 half{1};            ///< half the rectangle's sides in object space, where the type has one
};

/// Lengths of the images of the axes.
inline glm::dvec3 lengths(const Affine& map) {
  return {glm::length(map.linear[0]), glm::length(map.linear[1]), glm::length(map.linear[2])};
}

/// Some triangles of a mesh, and which of their half-edges are on the outside.
struct Region {
  const Topology& mesh;
  const Regions& regions;
  std::uint32_t id;

  std::span<const std::uint32_t> triangles() const { return regions[id]; }
  bool is_outline(std::uint32_t half_edge) const {
    const std::uint32_t twin = mesh.twins[half_edge];
    return twin == no_id || regions.of(twin / 3) != id;
  }
  glm::dvec3 corner(std::uint32_t triangle, int k) const { return mesh.positions[mesh.triangles[triangle][k]]; }
};

}  // namespace rayengine::surfaces
