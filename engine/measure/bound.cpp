#include "engine/measure/bound.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace rayengine {
namespace {

glm::dmat3 magnitudes(const glm::dmat3& m) { return {glm::abs(m[0]), glm::abs(m[1]), glm::abs(m[2])}; }

double largest(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

/// Sizes of coordinates taken through a map.
glm::dvec3 into(const WorldToObject& map, const glm::dvec3& sizes) {
  return magnitudes(map.linear) * (sizes + glm::abs(map.origin));
}
glm::dvec3 out_of(const WorldToObject& map, const glm::dvec3& sizes) {
  return magnitudes(object_to_world(map).linear) * sizes;
}

/// The larger of a triangle's corners' coordinates in every axis, and longest edge over height: 1 and a bit when
/// regular.
struct Extent {
  glm::dvec3 sizes{0};
  double slenderness = 1;
};

Extent extent(const Geometry& geometry, std::uint32_t triangle) {
  const glm::uvec3& index = geometry.triangles[triangle];
  const glm::dvec3 a = geometry.vertex(index.x), b = geometry.vertex(index.y), c = geometry.vertex(index.z);
  const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
  const double area = glm::length(glm::cross(b - a, c - a));
  return {glm::max(glm::abs(a), glm::max(glm::abs(b), glm::abs(c))), 1 + longest * longest / std::max(area, 1e-300)};
}

}  // namespace

double rounding_bound(const Geometry& geometry, const Limits& limits, const Ray& ray, const Hit& hit) {
  const PrimitiveRef ref = resolve(geometry, hit.object, hit.primitive);
  glm::dvec3 sizes = glm::abs(ray.origin) + std::abs(hit.t) * glm::abs(ray.direction);
  if (ref.instance) sizes = into(ref.instance->to_group, sizes);
  double scale = rounding_units * limits.quadric_roundoff;
  if (ref.is_triangle()) {
    const Extent triangle = extent(*ref.geometry, ref.triangle());
    sizes += triangle.sizes;
    scale = rounding_units * limits.triangle_roundoff * triangle.slenderness;
  } else {
    sizes = out_of(ref.quadric().to_object, into(ref.quadric().to_object, sizes));
  }
  if (ref.instance) sizes = out_of(ref.instance->to_group, sizes);
  return scale * largest(sizes);
}

}  // namespace rayengine
