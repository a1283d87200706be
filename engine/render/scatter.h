#pragma once

#include <glm/geometric.hpp>
#include <optional>

#include "accel/surface.h"
#include "engine/render/optics.h"

// Where light goes on from a surface that it meets along `direction`, of unit length. Interpolated normals bend and
// mirror it; the geometric normal says which side is which.
namespace rayengine {

inline glm::dvec3 facing(const glm::dvec3& normal, const glm::dvec3& direction) {
  return glm::dot(normal, direction) > 0 ? -normal : normal;
}

/// Whether both directions lie on the same side of the plane.
inline bool same_side(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& plane) {
  return glm::dot(a, plane) * glm::dot(b, plane) > 0;
}

/// The index on the ray's side over that behind the surface. Nested media are not tracked: outside is 1. An index of 0
/// is how files say that there is none.
inline double index_ratio(const Material& m, bool entering) {
  if (m.ior == 0) return 1;
  return entering ? 1 / static_cast<double>(m.ior) : m.ior;
}

/// Refracted. None at total internal reflection.
inline std::optional<glm::dvec3> passed_through(const glm::dvec3& direction, const Surface& surface,
                                                const Material& m) {
  const double eta = index_ratio(m, glm::dot(direction, surface.normal) < 0);
  const auto through = refracted(direction, facing(surface.shading_normal, direction), eta);
  // An interpolated normal may bend the ray back to where it came from: then it passes straight.
  if (through && !same_side(*through, direction, surface.normal)) return direction;
  return through;
}

inline glm::dvec3 mirrored(const glm::dvec3& direction, const Surface& surface) {
  const glm::dvec3 back = reflected(direction, facing(surface.shading_normal, direction));
  // The same below a mirror's own surface: then the flat normal reflects.
  return same_side(back, direction, surface.normal) ? reflected(direction, surface.normal) : back;
}

}  // namespace rayengine
