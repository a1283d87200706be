#pragma once

#include <glm/vec3.hpp>

#include "accel/quadric.h"

namespace rayengine {

/// A quadric and where it stands.
struct PlacedQuadric {
  QuadricShape shape;
  Affine to_world;
};

/// The open cone, frustum or cylinder between two circles about one axis: a unit cylinder when the radii are equal,
/// else a unit cone clipped between them. A frustum so near a cylinder that its apex is far away, which would cost
/// accuracy, is a general quadric that stands on its wider circle. Throws Error when the ends coincide, or the radii
/// are both zero or have different signs.
PlacedQuadric frustum(const glm::dvec3& base, double base_radius, const glm::dvec3& apex, double apex_radius);

}  // namespace rayengine
