#include "accel/kernels/kernels.h"
#include "accel/solve.h"
#include "accel/surface.h"

namespace rayengine {
namespace {

using Vec3 = kernels::Vec3<double>;

Vec3 kernel_vec(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

/// a r^2 + 2 b r + c
struct Coefficients {
  double a, b, c;
};

/// The form A x^2 + E y^2 + H z^2 + 2 I z + J, which all unit primitives have.
struct Diagonal {
  double A, E, H, I, J;

  explicit Diagonal(const QuadricMatrix& m) : A(m[0]), E(m[4]), H(m[7]), I(m[8]), J(m[9]) {}

  Coefficients along(const glm::dvec3& p, const glm::dvec3& d) const {
    Coefficients k;
    kernels::diagonal_coefficients(A, E, H, I, J, kernel_vec(p), kernel_vec(d), k.a, k.b, k.c);
    return k;
  }
  void make_absolute() { A = std::abs(A), E = std::abs(E), H = std::abs(H), I = std::abs(I), J = std::abs(J); }
  glm::dvec3 quadratic(const glm::dvec3& v) const { return {A * v.x, E * v.y, H * v.z}; }
  double linear(const glm::dvec3& v) const { return I * v.z; }
  glm::dvec3 gradient(const glm::dvec3& p) const { return {A * p.x, E * p.y, H * p.z + I}; }
  double constant() const { return J; }
};

/// All ten coefficients.
struct General {
  QuadricMatrix m;

  explicit General(const QuadricMatrix& m) : m(m) {}

  Coefficients along(const glm::dvec3& p, const glm::dvec3& d) const {
    Coefficients k;
    kernels::general_coefficients(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8], m[9], kernel_vec(p),
                                  kernel_vec(d), k.a, k.b, k.c);
    return k;
  }
  void make_absolute() {
    for (double& a : m) a = std::abs(a);
  }
  glm::dvec3 quadratic(const glm::dvec3& v) const {
    return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[1] * v.x + m[4] * v.y + m[5] * v.z,
            m[2] * v.x + m[5] * v.y + m[7] * v.z};
  }
  double linear(const glm::dvec3& v) const { return m[3] * v.x + m[6] * v.y + m[8] * v.z; }
  glm::dvec3 gradient(const glm::dvec3& p) const { return quadratic(p) + glm::dvec3(m[3], m[6], m[8]); }
  double constant() const { return m[9]; }
};

/// Half the gradient of the surface's form.
glm::dvec3 gradient(const Geometry& geometry, const Quadric& q, const glm::dvec3& p) {
  if (q.type == QuadricType::general) return General(geometry.forms[q.form].matrix).gradient(p);
  return Diagonal(unit_matrix(q.type)).gradient(p);
}

/// The ray in object space, its origin moved by `shift` to its closest approach.
struct Approach {
  LocalRay ray;
  double shift = 0;
};

Approach approach(const WorldToObject& map, const LocalRay& group_ray) {
  const LocalRay at_object = transformed(group_ray, map);
  const glm::dvec3 &o = at_object.origin, &d = at_object.direction;
  Approach a;
  Vec3 p;
  kernels::approach(kernel_vec(o), kernel_vec(d), p, a.shift);
  const double reach = std::abs(a.shift);
  // Two steps of a product and a sum each. A rounding of the shift itself only moves p along the ray, and is added to
  // t.
  a.ray = {{p.x, p.y, p.z},
           d,
           at_object.origin_error + gamma(4) * (glm::abs(o) + reach * glm::abs(d)) + reach * at_object.direction_error,
           at_object.direction_error};
  return a;
}

/// A bound on what all roundings may change in the form's value at p + r d: its coefficients are off by da, db, dc.
template <class Form>
double form_error(Form form, const LocalRay& ray, double r) {
  form.make_absolute();
  const glm::dvec3 p = glm::abs(ray.origin), d = glm::abs(ray.direction);
  const glm::dvec3 gp = form.gradient(p), qd = form.quadratic(d);
  const double da = gamma(7) * glm::dot(qd, d) + 2 * glm::dot(qd, ray.direction_error);
  const double db = gamma(7) * (glm::dot(qd, p) + form.linear(d)) + glm::dot(qd, ray.origin_error) +
                    glm::dot(gp, ray.direction_error);
  const double dc =
      gamma(8) * (glm::dot(gp, p) + form.linear(p) + form.constant()) + 2 * glm::dot(gp, ray.origin_error);
  return (da * r + 2 * db) * r + dc;
}

/// The root that the hit's t is nearest to. With the form off by e at r, r is off by 2 e / (2 |a r + b|) while that
/// slope is large against e; near a tangent, by the square root of e / |a|.
template <class Form>
Solution solve_side(const Form& form, const PrimitiveRef& ref, const LocalRay& group_ray, double t_guess) {
  const WorldToObject& map = ref.quadric().to_object;
  const Approach k = approach(map, group_ray);
  const auto [a, b, c] = form.along(k.ray.origin, k.ray.direction);
  double near, far;
  kernels::roots(a, b, c, near, far);
  const double guess = t_guess - k.shift;
  double r = std::abs(far - guess) < std::abs(near - guess) ? far : near;
  if (!(std::abs(r) < std::numeric_limits<double>::max())) r = a != 0 ? -b / a : guess;

  const double e = form_error(form, k.ray, std::abs(r)), slope = std::abs(a * r + b);
  const double along =
      slope * slope > 4 * std::abs(a) * e ? 2 * e / slope : 2 * slope / std::abs(a) + std::sqrt(e / std::abs(a));
  Solution s;
  s.t = k.shift + r;
  s.error = along + gamma(4) * std::abs(r) + gamma(2) * (std::abs(k.shift) + std::abs(s.t));
  const glm::dvec3 steepest =
      to_world(ref.instance, map.normal_to_world(form.gradient(k.ray.origin + r * k.ray.direction)));
  const auto [normal, per_length] = normalised(steepest);
  s.distance = e * per_length;
  s.normal = normal;
  return s;
}

/// A cap's normal: out of the solid at either end.
glm::dvec3 cap_normal(std::uint32_t part) { return {0, 0, part == 1 ? -1 : 1}; }

/// The plane of a cap: z = at in object space.
Solution solve_cap(const PrimitiveRef& ref, const LocalRay& group_ray, double at) {
  const WorldToObject& map = ref.quadric().to_object;
  const Approach k = approach(map, group_ray);
  const glm::dvec3 steepest = to_world(ref.instance, map.normal_to_world(cap_normal(ref.primitive)));
  const double height = at - k.ray.origin.z, climb = k.ray.direction.z, r = height / climb;
  const double e = k.ray.origin_error.z + std::abs(r) * k.ray.direction_error.z + gamma(2) * std::abs(height);
  Solution s;
  s.t = k.shift + r;
  s.error = e / std::abs(climb) + gamma(2) * (std::abs(k.shift) + std::abs(s.t));
  const auto [normal, per_length] = normalised(steepest);
  s.distance = e * per_length;
  s.normal = normal;
  return s;
}

}  // namespace

LocalRay transformed(const LocalRay& ray, const WorldToObject& map) {
  const glm::dmat3& m = map.linear;
  const glm::dmat3 sizes(glm::abs(m[0]), glm::abs(m[1]), glm::abs(m[2]));
  const glm::dvec3 from = ray.origin - map.origin;
  return {m * from, m * ray.direction, sizes * (gamma(5) * glm::abs(from) + ray.origin_error),
          sizes * (gamma(5) * glm::abs(ray.direction) + ray.direction_error)};
}

Solution solve_quadric(const PrimitiveRef& ref, const LocalRay& ray, double t_guess) {
  const Quadric& q = ref.quadric();
  if (ref.primitive != 0) return solve_cap(ref, ray, ref.primitive == 1 ? q.zmin : q.zmax);
  if (q.type == QuadricType::general) return solve_side(General(ref.geometry->forms[q.form].matrix), ref, ray, t_guess);
  return solve_side(Diagonal(unit_matrix(q.type)), ref, ray, t_guess);
}

glm::dvec3 quadric_normal(const Geometry& geometry, const Quadric& quadric, const Instance* instance,
                          std::uint32_t part, const glm::dvec3& point) {
  const glm::dvec3 local = quadric.to_object.point(instance ? instance->to_group.point(point) : point);
  const glm::dvec3 normal = part == 0 ? gradient(geometry, quadric, local) : cap_normal(part);
  return unit(to_world(instance, quadric.to_object.normal_to_world(normal)));
}

}  // namespace rayengine
