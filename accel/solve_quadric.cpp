#include "accel/kernels/kernels.h"
#include "accel/solve.h"
#include "accel/surface.h"

namespace rayengine {
namespace {

using formulas::gamma;
using Vec3 = formulas::Vec<double>;
using Diagonal = formulas::Diagonal<double>;

Diagonal diagonal(QuadricType type) {
  const QuadricMatrix& m = unit_matrix(type);
  return {m[0], m[4], m[7], m[8], m[9]};
}

/// A form of all ten coefficients, with what formulas::Diagonal has.
struct General {
  QuadricMatrix m;

  formulas::Coefficients<double> along(const Vec3& p, const Vec3& d) const {
    formulas::Coefficients<double> k;
    kernels::general_coefficients(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8], m[9], p, d, k.a, k.b, k.c);
    return k;
  }
  void make_absolute() {
    for (double& a : m) a = std::abs(a);
  }
  Vec3 quadratic(const Vec3& v) const {
    return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[1] * v.x + m[4] * v.y + m[5] * v.z,
            m[2] * v.x + m[5] * v.y + m[7] * v.z};
  }
  double linear(const Vec3& v) const { return m[3] * v.x + m[6] * v.y + m[8] * v.z; }
  Vec3 gradient(const Vec3& p) const { return formulas::plus(quadratic(p), Vec3{m[3], m[6], m[8]}); }
  double constant() const { return m[9]; }
};

/// Half the gradient of the surface's form.
Vec3 gradient(const Geometry& geometry, const Quadric& q, const Vec3& p) {
  if (q.type == QuadricType::general) return General{geometry.forms[q.form].matrix}.gradient(p);
  return diagonal(q.type).gradient(p);
}

template <class Form>
Solution solve_side(const Form& form, const PrimitiveRef& ref, const GroupRay& ray, double t_guess) {
  const auto x = formulas::cross_side(form, map_of(ref.quadric().to_object), ray, t_guess);
  const Direction normal = normalised(to_world(ref.instance, glm_vec(x.steepest)));
  return {.t = x.t, .error = x.error, .distance = x.form_error * normal.per_length, .normal = normal.unit};
}

/// A cap's normal: out of the solid at either end.
glm::dvec3 cap_normal(std::uint32_t part) { return {0, 0, part == 1 ? -1 : 1}; }

/// The plane of a cap: z = at in object space.
Solution solve_cap(const PrimitiveRef& ref, const GroupRay& ray, double at) {
  const WorldToObject& map = ref.quadric().to_object;
  const auto k = formulas::approach(map_of(map), ray);
  const double height = at - k.ray.origin.z, climb = k.ray.direction.z, r = height / climb;
  const double e = k.ray.origin_error.z + std::abs(r) * k.ray.direction_error.z + gamma(2) * std::abs(height);
  Solution s;
  s.t = k.shift + r;
  s.error = e / std::abs(climb) + gamma(2) * (std::abs(k.shift) + std::abs(s.t));
  const auto [normal, per_length] = normalised(to_world(ref.instance, map.normal_to_world(cap_normal(ref.primitive))));
  s.distance = e * per_length;
  s.normal = normal;
  return s;
}

}  // namespace

Solution solve_quadric(const PrimitiveRef& ref, const GroupRay& ray, double t_guess) {
  const Quadric& q = ref.quadric();
  if (ref.primitive != 0) return solve_cap(ref, ray, ref.primitive == 1 ? q.zmin : q.zmax);
  if (q.type == QuadricType::general) return solve_side(General{ref.geometry->forms[q.form].matrix}, ref, ray, t_guess);
  return solve_side(diagonal(q.type), ref, ray, t_guess);
}

Solution with_traced_t(const PrimitiveRef& ref, const GroupRay& ray, Solution solution) {
  const Quadric& q = ref.quadric();
  const bool ball = q.type == QuadricType::sphere;
  if (ref.primitive != 0 || q.capped || !(ball || q.type == QuadricType::cylinder)) return solution;
  const auto [o, d, unused, unused_too] = formulas::transformed(ray, map_of(q.to_object));
  double dd, near, far;
  const double under_root = kernels::round_discriminant(ball, o, d, dd);
  kernels::round_roots(ball, o, d, dd, under_root, near, far);
  const double t = std::abs(far - solution.t) < std::abs(near - solution.t) ? far : near;
  if (!(t < std::numeric_limits<double>::max())) return solution;
  solution.error = (solution.error + std::abs(t - solution.t)) * (1 + 4 * gamma(1));
  solution.t = t;
  return solution;
}

glm::dvec3 quadric_normal(const Geometry& geometry, const Quadric& quadric, const Instance* instance,
                          std::uint32_t part, const glm::dvec3& point) {
  const glm::dvec3 local = quadric.to_object.point(instance ? instance->to_group.point(point) : point);
  const glm::dvec3 normal = part == 0 ? glm_vec(gradient(geometry, quadric, kernel_vec(local))) : cap_normal(part);
  return unit(to_world(instance, quadric.to_object.normal_to_world(normal)));
}

}  // namespace rayengine
