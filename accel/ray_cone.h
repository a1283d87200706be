#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "accel/geometry.h"

// Which spheres a bundle of rays can meet at all. Source: Szecsi, "The Hierarchical Ray Engine" (WSCG 2006); the
// formulas are in kernels/ray_cone.glsl, which the GPU builds and tests its cones with, too.
namespace rayengine {

/// What a cone is built of. Any length of direction but zero.
struct ConeRay {
  glm::vec3 origin{0}, direction{0, 0, 1};
};

/// An infinite cone, in single precision. It holds no rays when the cosine is above 1, all that there can be when it is
/// negative.
struct RayCone {
  glm::vec3 apex{0}, axis{0, 0, 1};
  float cosine = 2, sine = 0;  ///< of half the opening angle
};

/// A cone that holds all of the rays, from their origins to infinity, whatever rounding does.
RayCone enclosing_cone(std::span<const ConeRay> rays);

struct Sphere {
  glm::dvec3 center{0};
  double radius = 0;  ///< infinite where the primitive has no end
};

/// The smallest sphere around a triangle.
Sphere enclosing_sphere(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

/// A sphere around a quadric as far as its clips let it reach: about a quadric of type sphere that of its longest axis,
/// about others that of their bounding box.
Sphere enclosing_sphere(const Geometry& geometry, const Quadric& quadric);

/// Whether a ray of the cone may meet the sphere; never false when one does.
bool may_meet(const RayCone& cone, const glm::vec3& center, float radius);

}  // namespace rayengine
