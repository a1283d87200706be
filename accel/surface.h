#pragma once

#include <span>

#include "accel/geometry.h"
#include "accel/ray.h"

namespace rayengine {

/// A hit worked out in double on the primitive that its ids name: what shading needs, and how wrong it can be.
struct Surface {
  glm::dvec3 position{0};
  glm::dvec3 normal{0};          ///< unit geometric normal, oriented as Hit::normal
  glm::dvec3 shading_normal{0};  ///< unit; interpolated where the mesh has normals
  double error = 0;              ///< bound on the distance, along the normal, between `position` and the surface
  double magnitude = 0;          ///< largest absolute coordinate of `position` and of the triangle's vertices; where an
                                 ///< instance's map shifts them, of what is seen there, in world units along the normal
  double spread = 0;             ///< diameter of the triangle's circumscribed circle, likewise; 0 on quadrics
  std::uint32_t material = 0;
  bool is_triangle = false;
};

/// Needs hit.hit(), and the geometry that was hit.
Surface surface_at(const Geometry& geometry, const Ray& ray, const Hit& hit);

/// The surfaces of many hits; those of misses are left as they are. The same numbers as one by one, several at a time.
void surfaces_at(const Geometry& geometry, std::span<const Ray> rays, std::span<const Hit> hits,
                 std::span<Surface> surfaces);

/// The same hit with t, barycentrics, normal and the bound on t worked out in double for the primitive that it names.
Hit refine(const Geometry& geometry, const Ray& ray, const Hit& hit);

/// The world-space unit normal at `point` of a quadric's part: 0 side, 1 lower cap, 2 upper cap. `instance` may be
/// null.
glm::dvec3 quadric_normal(const Geometry& geometry, const Quadric& quadric, const Instance* instance,
                          std::uint32_t part, const glm::dvec3& point);

/// The normal of a triangle in its geometry's own space, by its counter-clockwise corners; not normalised.
glm::dvec3 triangle_normal(const Geometry& geometry, std::uint32_t triangle);

}  // namespace rayengine
