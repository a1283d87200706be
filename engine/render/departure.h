#pragma once

#include <cmath>
#include <glm/geometric.hpp>

#include "accel/surface.h"
#include "accel/tracer.h"

namespace rayengine {

/// How far off a surface a ray must start, in units of u * magnitude, for a tracer whose arithmetic has round-off u not
/// to hit again what the ray leaves. All terms are distances along the unit normal, M is Surface::magnitude, and S <= 2
/// sqrt(3) M is the triangle's longest vertex distance as seen from the origin:
///   rounding the origin's coordinates                            sqrt(3) u M
///   rounding the vertices' (the triangle moves as they do)       sqrt(3) u M
///   rounding vertices minus origin, at most u S each             2 sqrt(3) u M
///   edges (u) and their cross product N: |dN| <= (2 sqrt(3) / sin + 1) u |N|, times S:
///                                                                (12 / sin + 2 sqrt(3)) u M
///   the dot product with N: 3 u S                                6 sqrt(3) u M
/// where `sin` is of the angle between the two edges. The sum is below 64 u M for corners between 20 and 160 degrees;
/// quadrics lose less: the point in object space, the closest approach and the stable root are each within a few u of
/// the magnitudes.
inline constexpr double departure_units = 64;

/// Where rays leave a hit from: off the surface by what is unsure of it, on the side the new ray goes to.
struct Departure {
  glm::dvec3 position{0};
  glm::dvec3 clearance{0};  ///< along the geometric normal

  Departure() = default;
  Departure(const Surface& s, const Limits& limits) : position(s.position) {
    const double roundoff = s.is_triangle ? limits.triangle_roundoff : limits.quadric_roundoff;
    // The surface's own error counts twice: for where the point is, and for where the tracer's arithmetic sees the
    // surface.
    clearance = (2 * s.error + departure_units * roundoff * s.magnitude) * s.normal;
  }

  glm::dvec3 towards(const glm::dvec3& direction) const {
    return glm::dot(clearance, direction) < 0 ? position - clearance : position + clearance;
  }
};

}  // namespace rayengine
