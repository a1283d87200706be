#include "accel/ray_cone.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "accel/kernels/kernels.h"

namespace rayengine {
namespace {

using Vec = kernels::Vec3<float>;

Vec vec(const glm::vec3& v) { return {v.x, v.y, v.z}; }
glm::vec3 vec(const Vec& v) { return {v.x, v.y, v.z}; }

Vec direction_of(const ConeRay& ray) { return kernels::unit_vector(vec(ray.direction)); }

struct Growing {
  Vec apex, axis;
  float cosine, sine;

  explicit Growing(const ConeRay& first) : apex(vec(first.origin)), axis(direction_of(first)) {
    kernels::cone_opened(0.f, cosine, sine);
  }

  void add(const ConeRay& ray) {
    kernels::cone_extended(axis, cosine, sine, direction_of(ray), axis, cosine, sine);
    apex = kernels::cone_translated(apex, axis, cosine, sine, vec(ray.origin));
  }

  void settle(std::span<const ConeRay> rays) {
    const float tangent = sine / cosine;
    float widest = tangent, setback = -static_cast<float>(infinity);
    for (const ConeRay& ray : rays) {
      widest = kernels::larger(widest, kernels::cone_tangent(axis, direction_of(ray)));
      setback = kernels::larger(setback, kernels::cone_setback(apex, axis, tangent, vec(ray.origin)));
    }
    kernels::cone_settled(apex, axis, cosine, widest, setback, apex, cosine, sine);
  }
};

}  // namespace

RayCone enclosing_cone(std::span<const ConeRay> rays) {
  if (rays.empty()) return {};
  Growing cone(rays.front());
  for (const ConeRay& ray : rays.subspan(1)) cone.add(ray);
  cone.settle(rays);
  return {vec(cone.apex), vec(cone.axis), cone.cosine, cone.sine};
}

namespace {

/// Around a triangle whose longest side is opposite to `a`, the only corner that may be obtuse.
glm::dvec3 center_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 u = b - a, v = c - a, n = glm::cross(u, v);
  const double nn = glm::dot(n, n);
  if (!(glm::dot(u, v) > 0 && nn > 0)) return 0.5 * (b + c);
  return a + (glm::dot(u, u) * glm::cross(v, n) + glm::dot(v, v) * glm::cross(n, u)) / (2 * nn);
}

/// At least as much as the map stretches any vector; exactly that where it scales along its own axes, then turns.
double largest_stretch(const glm::dmat3& map) {
  const glm::dmat3 square = glm::transpose(map) * map;
  double most = 0;
  for (int i = 0; i < 3; ++i)
    most = std::max(most, std::abs(square[i].x) + std::abs(square[i].y) + std::abs(square[i].z));
  return std::sqrt(most);
}

}  // namespace

Sphere enclosing_sphere(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const double ab = glm::distance(a, b), bc = glm::distance(b, c), ca = glm::distance(c, a);
  const glm::dvec3 center = bc >= std::max(ab, ca) ? center_of(a, b, c)
                            : ca >= ab             ? center_of(b, c, a)
                                                   : center_of(c, a, b);
  return {center, std::max({glm::distance(center, a), glm::distance(center, b), glm::distance(center, c)})};
}

Sphere enclosing_sphere(const Geometry& geometry, const Quadric& quadric) {
  const Box box = bounds(geometry, quadric);
  if (!box.finite()) return {glm::dvec3(0), infinity};
  Sphere sphere{box.center(), 0.5 * glm::length(box.size())};
  if (quadric.type != QuadricType::sphere) return sphere;
  const Affine map = object_to_world(quadric.to_object);
  const double longest = largest_stretch(map.linear) * (1 + 1e-12);
  return longest < sphere.radius ? Sphere{map.origin, longest} : sphere;
}

bool may_meet(const RayCone& cone, const glm::vec3& center, float radius) {
  return !kernels::cone_passes(vec(cone.apex), vec(cone.axis), cone.cosine, cone.sine, vec(center), radius);
}

}  // namespace rayengine
