#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "accel/surface.h"
#include "accel/tracer.h"

namespace rayengine {

/// How far from a triangle a tracer whose arithmetic has round-off u may still see it where a ray leaves it. All terms
/// are distances along the unit normal; M is Surface::magnitude, and S, the longest distance of a vertex from the
/// origin, and the edges a, b, c are bounded by D = Surface::spread = a b c / |N|:
///   rounding the origin's coordinates                              sqrt(3) u M
///   rounding the vertices' (the triangle moves as they do)         sqrt(3) u M
///   rounding vertices minus origin                                 u S
///   edges (u) and their cross product N: |dN| S / |N|, where |dN| <= 2 sqrt(3) u a b + u |N|
///                                                                  2 sqrt(3) u D + u S
///   the dot product with N                                         3 u S
/// which add up to less than u (4 M + 9 D).
inline double triangle_clearance(const Surface& s, double u) { return u * (4 * s.magnitude + 9 * s.spread); }

/// The same for quadrics: the way to object space, the closest approach and the stable root are each within a few u of
/// the coordinates' magnitude, and 64 covers them all.
inline double quadric_clearance(const Surface& s, double u) { return 64 * u * s.magnitude; }

/// How rays leave a hit: from the point itself, but blind until they have risen above all that is unsure of the
/// surface. To move the origin instead would move every shadow's edge with it.
struct Departure {
  glm::dvec3 position{0};
  glm::dvec3 normal{0};  ///< geometric
  double clearance = 0;  ///< distance along the normal

  void set(const Surface& s, const Limits& limits) {
    position = s.position;
    normal = s.normal;
    const double u =
        std::max(limits.clearance_roundoff, s.is_triangle ? limits.triangle_roundoff : limits.quadric_roundoff);
    const double seen = s.is_triangle ? triangle_clearance(s, u) : quadric_clearance(s, u);
    // The surface's own error counts for where the point is and for where the tracer's arithmetic sees the surface; and
    // a ray that rises from a hollow takes up to twice as long to clear it as from a plane.
    clearance = 4 * s.error + seen;
  }

  /// Written in place: rays are built by the million, and a copy would cost more than the rest.
  void start(Ray& ray, const glm::dvec3& direction, double tmax) const {
    const double rise = std::abs(glm::dot(normal, direction));
    ray.origin = position;
    ray.tmin = std::min(tmax, clearance / rise);
    ray.direction = direction;
    ray.tmax = tmax;
  }
  Ray ray(const glm::dvec3& direction, double tmax) const {
    Ray result;
    start(result, direction, tmax);
    return result;
  }
};

}  // namespace rayengine
