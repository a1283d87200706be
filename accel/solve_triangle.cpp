#include "accel/solve.h"
#include "accel/surface.h"

namespace rayengine {

/// t of the triangle's plane by n.(a - o) / n.d, whose roundings are bounded term by term (see docs/accuracy.md).
Solution solve_triangle(const PrimitiveRef& ref, const GroupRay& ray, double t_guess) {
  const Geometry& g = *ref.geometry;
  const glm::uvec3 corners = g.triangles[ref.triangle()];
  const auto a = kernel_vec(g.vertex(corners.x));
  const auto plane = formulas::plane_of(a, kernel_vec(g.vertex(corners.y)), kernel_vec(g.vertex(corners.z)), ray);
  const glm::dvec3 n = glm_vec(plane.n);
  const Direction flat = normalised(n), world = ref.instance ? normalised(to_world(ref.instance, n)) : flat;
  // A distance along the normal in an instance's group, times this, is one in the world.
  const double stretch = ref.instance ? world.per_length / flat.per_length : 1;

  Solution s{.t = t_guess, .error = infinity, .normal = world.unit};
  s.magnitude = stretch * plane.largest;
  if (ref.instance) s.magnitude += largest_component(ref.instance->to_group.origin);
  s.spread = world.per_length * plane.sides;
  const double under = std::abs(plane.under);
  if (under <= plane.under_error) return s;  // seen edge-on: nothing better can be said than what is known
  const auto x = formulas::cross_plane(plane, a, ray, kernel_vec(flat.unit), flat.per_length);
  s.t = x.t, s.error = x.error;
  s.distance = s.error * under * world.per_length;
  s.barycentrics = {x.u, x.v};
  return s;
}

glm::dvec3 triangle_normal(const Geometry& g, std::uint32_t triangle) {
  const glm::uvec3 t = g.triangles[triangle];
  const glm::dvec3 a = g.vertex(t.x);
  return glm::cross(g.vertex(t.y) - a, g.vertex(t.z) - a);
}

}  // namespace rayengine
