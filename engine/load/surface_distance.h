#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "accel/bvh.h"

namespace rayengine {

using Corners = std::array<glm::dvec3, 3>;

inline Corners corners(std::span<const glm::dvec3> positions, const glm::uvec3& t) {
  return {positions[t.x], positions[t.y], positions[t.z]};
}

double longest_edge(const Corners& triangle);

/// Along the normal, and twice as long as the area.
glm::dvec3 area_vector(const Corners& triangle);

/// Cut at the middles of its edges.
std::array<Corners, 4> quartered(const Corners& triangle);

/// From a point to a triangle, edges included. One whose normal cannot be told is taken as its edges.
double squared_distance(const glm::dvec3& point, const Corners& triangle);

/// The largest distance of a point of `from` from `to`, squared; at a corner, since distance from a convex set is
/// convex.
double squared_reach(const Corners& from, const Corners& to);

/// Whether all of `from` is so near to `to`.
bool is_within(const Corners& from, const Corners& to, double squared_distance);

/// A triangle mesh that is asked how far others are from it. `positions` must outlive it.
class MeshSurface {
 public:
  MeshSurface(std::span<const glm::dvec3> positions, std::vector<glm::uvec3> triangles);

  /// A bound, at most `limit`, on the distance of the points of `triangle` from this surface: proven by cutting the
  /// triangle into parts, each near one triangle of the surface. Nothing where no such proof was found.
  std::optional<double> bound(const Corners& triangle, double limit) const;

 private:
  struct Query;
  std::optional<double> first_near(std::uint32_t node, const Query& query) const;
  std::optional<double> near_one(const Corners& part, double limit) const;
  std::optional<double> bound(const Corners& part, double limit, int cuts) const;

  std::span<const glm::dvec3> positions_;
  std::vector<glm::uvec3> triangles_;
  BinaryBvh bvh_;
};

struct Excursion {
  double distance = 0;                ///< a bound, of those that are no strays
  std::vector<std::uint32_t> strays;  ///< triangles that may have points farther than the limit from the surface
};

/// Of triangles from a surface.
Excursion excursion(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles,
                    const MeshSurface& surface, double limit);

}  // namespace rayengine
