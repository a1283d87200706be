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
  const glm::dvec3 n = glm::cross(ab, ac), n_abs = cross_abs(ab, ac);
  const Direction flat = normalised(n), world = ref.instance ? normalised(to_world(ref.instance, n)) : flat;
  // A distance along the normal in an instance's group, times this, is one in the world.
  const double stretch = ref.instance ? world.per_length / flat.per_length : 1;

  Solution s{.t = t_guess, .error = infinity, .normal = world.unit};
  s.magnitude = stretch * std::max({largest_component(a), largest_component(b), largest_component(c)});
  if (ref.instance) s.magnitude += largest_component(ref.instance->to_group.origin);
  s.spread = world.per_length * std::sqrt(glm::dot(ab, ab) * glm::dot(ac, ac) * glm::dot(bc, bc));

  const double over = glm::dot(n, ao), under = glm::dot(n, ray.direction);
  const double over_error = gamma(9) * dot_abs(n_abs, ao) + glm::dot(n_abs, ray.origin_error);
  const double under_error = gamma(8) * dot_abs(n_abs, ray.direction) + glm::dot(n_abs, ray.direction_error);
  if (std::abs(under) <= under_error) return s;  // seen edge-on: nothing better can be said than what is known
  s.t = over / under;
  s.error = (over_error + std::abs(s.t) * under_error) / (std::abs(under) - under_error) + roundoff * std::abs(s.t);
  s.distance = s.error * std::abs(under) * world.per_length;
  const glm::dvec3 p = ray.origin + s.t * ray.direction - a;
  s.barycentrics =
      flat.per_length * glm::dvec2(glm::dot(flat.unit, glm::cross(p, ac)), glm::dot(flat.unit, glm::cross(ab, p)));
  return s;
}

glm::dvec3 triangle_normal(const Geometry& g, std::uint32_t triangle) {
  const glm::uvec3 t = g.triangles[triangle];
  const glm::dvec3 a = g.vertex(t.x);
  return glm::cross(g.vertex(t.y) - a, g.vertex(t.z) - a);
}

}  // namespace rayengine
