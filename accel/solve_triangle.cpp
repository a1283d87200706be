#include "accel/solve.h"
#include "accel/surface.h"

namespace rayengine {
namespace {

glm::dvec3 cross_abs(const glm::dvec3& a, const glm::dvec3& b) {
  return {std::abs(a.y * b.z) + std::abs(a.z * b.y), std::abs(a.z * b.x) + std::abs(a.x * b.z),
          std::abs(a.x * b.y) + std::abs(a.y * b.x)};
}

/// A dot product of what is positive with what need not be, as if it were.
double dot_abs(const glm::dvec3& positive, const glm::dvec3& b) { return glm::dot(positive, glm::abs(b)); }

}  // namespace

/// t of the triangle's plane by n.(a - o) / n.d, whose roundings are bounded term by term (see docs/accuracy.md).
Solution solve_triangle(const PrimitiveRef& ref, const LocalRay& ray, double t_guess) {
  const Geometry& g = *ref.geometry;
  const glm::uvec3 corners = g.triangles[ref.triangle()];
  const glm::dvec3 a = g.vertex(corners.x), b = g.vertex(corners.y), c = g.vertex(corners.z);
  const glm::dvec3 ab = b - a, ac = c - a, bc = c - b, ao = a - ray.origin;
  const glm::dvec3 n = glm::cross(ab, ac), n_abs = cross_abs(ab, ac), n_world = to_world(ref.instance, n);
  const double nn = glm::dot(n, n), length = std::sqrt(nn);
  // A distance along the normal in an instance's group is this much of one in the world.
  const double stretch = ref.instance ? length / glm::length(n_world) : 1;

  Solution s{.t = t_guess, .error = infinity, .normal = unit(n_world, ref.instance ? glm::dot(n_world, n_world) : nn)};
  s.magnitude = stretch * std::max({largest(a), largest(b), largest(c)});
  if (ref.instance) s.magnitude += largest(ref.instance->to_group.origin);
  s.spread = stretch * std::sqrt(glm::dot(ab, ab) * glm::dot(ac, ac) * glm::dot(bc, bc)) / length;

  const double over = glm::dot(n, ao), under = glm::dot(n, ray.direction);
  const double over_error = gamma(9) * dot_abs(n_abs, ao) + glm::dot(n_abs, ray.origin_error);
  const double under_error = gamma(8) * dot_abs(n_abs, ray.direction) + glm::dot(n_abs, ray.direction_error);
  if (std::abs(under) <= under_error) return s;  // seen edge-on: nothing better can be said than what is known
  s.t = over / under;
  s.error = (over_error + std::abs(s.t) * under_error) / (std::abs(under) - under_error) + roundoff * std::abs(s.t);
  s.distance = stretch * s.error * std::abs(under) / length;
  const glm::dvec3 p = ray.origin + s.t * ray.direction - a;
  s.barycentrics = glm::dvec2(glm::dot(n, glm::cross(p, ac)), glm::dot(n, glm::cross(ab, p))) / nn;
  return s;
}

glm::dvec3 triangle_normal(const Geometry& g, std::uint32_t triangle) {
  const glm::uvec3 t = g.triangles[triangle];
  const glm::dvec3 a = g.vertex(t.x);
  return glm::cross(g.vertex(t.y) - a, g.vertex(t.z) - a);
}

}  // namespace rayengine
