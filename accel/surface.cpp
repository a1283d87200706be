#include "accel/surface.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "accel/kernels/kernels.h"

namespace rayengine {
namespace {

constexpr double u = 0x1p-53;  // unit round-off of double

/// A bound for n roundings in a row: n u / (1 - n u).
constexpr double gamma(int n) { return n * u / (1 - n * u); }

glm::dvec3 cross_abs(const glm::dvec3& a, const glm::dvec3& b) {
  return {std::abs(a.y * b.z) + std::abs(a.z * b.y), std::abs(a.z * b.x) + std::abs(a.x * b.z),
          std::abs(a.x * b.y) + std::abs(a.y * b.x)};
}

double dot_abs(const glm::dvec3& a, const glm::dvec3& b) {
  return std::abs(a.x * b.x) + std::abs(a.y * b.y) + std::abs(a.z * b.z);
}

double largest(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

glm::dvec3 unit(const glm::dvec3& v) {
  const double square = glm::dot(v, v);
  if (square > 1e-280 && square < 1e280) return v / std::sqrt(square);
  const double scale = largest(v);  // squares would vanish or overflow
  if (!(scale > 0)) return {0, 0, 0};
  const glm::dvec3 w = v / scale;
  return w / glm::length(w);
}

/// A solution along the ray with a bound on its error, and one on the distance of that point from the surface.
struct Solution {
  double t = 0, error = 0, distance = 0;
  glm::dvec2 barycentrics{0};
};

struct Corners {
  glm::dvec3 a, b, c;
};

Corners corners(const PrimitiveRef& ref) {
  const Geometry& g = *ref.geometry;
  const glm::uvec3 t = g.triangles[ref.triangle()];
  return {g.vertex(t.x), g.vertex(t.y), g.vertex(t.z)};
}

/// The ray in the space of the primitive's geometry.
Ray local_ray(const PrimitiveRef& ref, const Ray& ray) {
  if (!ref.instance) return ray;
  return {ref.instance->to_group.point(ray.origin), ray.tmin, ref.instance->to_group.vector(ray.direction), ray.tmax};
}

/// What taking a ray through a map adds to the uncertainty of its origin and direction: 5 roundings a component.
struct RayError {
  glm::dvec3 origin{0}, direction{0};
};

glm::dvec3 abs_product(const glm::dmat3& m, const glm::dvec3& v) {
  const glm::dvec3 a = glm::abs(v);
  return glm::abs(m[0]) * a.x + glm::abs(m[1]) * a.y + glm::abs(m[2]) * a.z;
}

RayError transform_error(const WorldToObject& map, const Ray& ray, const RayError& before = {}) {
  const glm::dvec3 from = ray.origin - map.origin;
  return {gamma(5) * abs_product(map.linear, from) + abs_product(map.linear, before.origin),
          gamma(5) * abs_product(map.linear, ray.direction) + abs_product(map.linear, before.direction)};
}

RayError local_error(const PrimitiveRef& ref, const Ray& ray) {
  return ref.instance ? transform_error(ref.instance->to_group, ray) : RayError{};
}

/// t of the triangle's plane by n.(a - o) / n.d, whose roundings are bounded term by term (see docs/accuracy.md).
Solution solve_triangle(const PrimitiveRef& ref, const Ray& world_ray, double t_guess) {
  const Ray ray = local_ray(ref, world_ray);
  const RayError in = local_error(ref, world_ray);
  const Corners k = corners(ref);
  const glm::dvec3 ab = k.b - k.a, ac = k.c - k.a, ao = k.a - ray.origin;
  const glm::dvec3 n = glm::cross(ab, ac), n_abs = cross_abs(ab, ac);
  const double over = glm::dot(n, ao), under = glm::dot(n, ray.direction);
  const double over_error = gamma(9) * dot_abs(n_abs, ao) + dot_abs(n_abs, in.origin);
  const double under_error = gamma(8) * dot_abs(n_abs, ray.direction) + dot_abs(n_abs, in.direction);
  Solution s{t_guess, infinity, infinity};
  if (std::abs(under) <= under_error) return s;  // seen edge-on: nothing better can be said than what is known
  s.t = over / under;
  s.error = (over_error + std::abs(s.t) * under_error) / (std::abs(under) - under_error) + u * std::abs(s.t);
  s.distance = s.error * std::abs(under) / glm::length(n);
  const glm::dvec3 p = ray.at(s.t) - k.a;
  const double nn = glm::dot(n, n);
  s.barycentrics = {glm::dot(n, glm::cross(p, ac)) / nn, glm::dot(n, glm::cross(ab, p)) / nn};
  return s;
}

const QuadricMatrix& matrix(const Geometry& geometry, const Quadric& q) {
  return q.type == QuadricType::general ? geometry.forms[q.form].matrix : unit_matrix(q.type);
}

glm::dvec3 linear_part(const QuadricMatrix& m, const glm::dvec3& v) {
  return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[1] * v.x + m[4] * v.y + m[5] * v.z,
          m[2] * v.x + m[5] * v.y + m[7] * v.z};
}

QuadricMatrix absolute(QuadricMatrix m) {
  for (double& a : m) a = std::abs(a);
  return m;
}

/// Half the gradient of x^T Q x.
glm::dvec3 gradient(const QuadricMatrix& m, const glm::dvec3& p) {
  return linear_part(m, p) + glm::dvec3(m[3], m[6], m[8]);
}

/// The ray in the quadric's object space, moved to its closest approach, with bounds on what the moving cost.
struct Approach {
  glm::dvec3 p, d;
  double shift = 0;
  RayError error;
};

Approach approach(const PrimitiveRef& ref, const Ray& world_ray) {
  const Ray ray = local_ray(ref, world_ray);
  const WorldToObject& map = ref.quadric().to_object;
  const RayError in = transform_error(map, ray, local_error(ref, world_ray));
  const glm::dvec3 o = map.point(ray.origin), d = map.vector(ray.direction);
  kernels::Vec3<double> p;
  Approach a;
  kernels::approach(kernels::Vec3<double>(o.x, o.y, o.z), kernels::Vec3<double>(d.x, d.y, d.z), p, a.shift);
  a.p = {p.x, p.y, p.z}, a.d = d;
  // Two steps of a product and a sum each; a rounding of the shift itself only moves p along the ray, and is added to
  // t.
  a.error.origin =
      in.origin + gamma(4) * (glm::abs(o) + std::abs(a.shift) * glm::abs(d)) + std::abs(a.shift) * in.direction;
  a.error.direction = in.direction;
  return a;
}

/// A normal (or gradient) of the geometry that holds the primitive, taken to world space; not normalised.
glm::dvec3 to_world(const PrimitiveRef& ref, const glm::dvec3& normal) {
  return ref.instance ? ref.instance->to_group.normal_to_world(normal) : normal;
}

/// The root that the hit's t is nearest to, with the effect of all roundings on it: if the coefficients of
/// a r^2 + 2 b r + c are off by da, db, dc, the form at r is off by e = da r^2 + 2 db |r| + dc, and r by 2 e / (2 |a r
/// + b|) while that slope is large against e; near a tangent, by the square root of e / |a|.
Solution solve_side(const PrimitiveRef& ref, const Ray& ray, double t_guess) {
  const Approach k = approach(ref, ray);
  const QuadricMatrix& m = matrix(*ref.geometry, ref.quadric());
  const QuadricMatrix m_abs = absolute(m);
  double a, b, c, near, far;
  kernels::general_coefficients(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8], m[9],
                                kernels::Vec3<double>(k.p.x, k.p.y, k.p.z), kernels::Vec3<double>(k.d.x, k.d.y, k.d.z),
                                a, b, c);
  kernels::roots(a, b, c, near, far);
  const double guess = t_guess - k.shift;
  const bool first = !(std::abs(far - guess) < std::abs(near - guess));
  double r = first ? near : far;
  if (!(std::abs(r) < std::numeric_limits<double>::max())) r = a != 0 ? -b / a : guess;
  const glm::dvec3 p = glm::abs(k.p), d = glm::abs(k.d);
  const glm::dvec3 gp = gradient(m_abs, p), ld = linear_part(m_abs, d);
  const double dw = m_abs[3] * d.x + m_abs[6] * d.y + m_abs[8] * d.z;
  const double form_abs = glm::dot(gp, p) + m_abs[3] * p.x + m_abs[6] * p.y + m_abs[8] * p.z + m_abs[9];
  const double da = gamma(7) * glm::dot(ld, d) + 2 * glm::dot(ld, k.error.direction);
  const double db = gamma(7) * (glm::dot(ld, p) + dw) + glm::dot(ld, k.error.origin) + glm::dot(gp, k.error.direction);
  const double dc = gamma(8) * form_abs + 2 * glm::dot(gp, k.error.origin);
  const double e = da * r * r + 2 * db * std::abs(r) + dc;
  const double slope = std::abs(a * r + b);
  Solution s;
  s.t = k.shift + r;
  const double along =
      slope * slope > 4 * std::abs(a) * e ? 2 * e / slope : 2 * slope / std::abs(a) + std::sqrt(e / std::abs(a));
  s.error = along + gamma(4) * std::abs(r) + gamma(2) * (std::abs(k.shift) + std::abs(s.t));
  const glm::dvec3 at = k.p + r * k.d;
  const glm::dvec3 world_gradient = to_world(ref, ref.quadric().to_object.normal_to_world(gradient(m, at)));
  s.distance = std::min(e / glm::length(world_gradient), s.error * glm::length(ray.direction));
  return s;
}

/// The plane of a cap: z = at in object space.
Solution solve_cap(const PrimitiveRef& ref, const Ray& ray, double at) {
  const Approach k = approach(ref, ray);
  Solution s;
  const double r = (at - k.p.z) / k.d.z;
  s.t = k.shift + r;
  s.error = (k.error.origin.z + std::abs(r) * k.error.direction.z + gamma(2) * std::abs(at - k.p.z)) / std::abs(k.d.z) +
            gamma(2) * (std::abs(k.shift) + std::abs(s.t));
  const glm::dvec3 normal = ref.quadric().to_object.normal_to_world({0, 0, 1});
  s.distance = s.error * std::abs(k.d.z) / glm::length(normal);
  return s;
}

Solution solve(const PrimitiveRef& ref, const Ray& ray, double t_guess) {
  if (ref.is_triangle()) return solve_triangle(ref, ray, t_guess);
  const Quadric& q = ref.quadric();
  if (ref.primitive == 0) return solve_side(ref, ray, t_guess);
  return solve_cap(ref, ray, ref.primitive == 1 ? q.zmin : q.zmax);
}

glm::dvec3 geometric_normal(const PrimitiveRef& ref, const glm::dvec3& point) {
  if (ref.is_triangle()) return unit(to_world(ref, triangle_normal(*ref.geometry, ref.triangle())));
  return quadric_normal(*ref.geometry, ref.quadric(), ref.instance, ref.primitive, point);
}

glm::dvec3 shading_normal(const PrimitiveRef& ref, const glm::dvec2& barycentrics, const glm::dvec3& geometric) {
  const Geometry& g = *ref.geometry;
  if (!ref.is_triangle() || g.normals.empty()) return geometric;
  const glm::uvec3 t = g.triangles[ref.triangle()];
  const glm::dvec3 a(g.normals[t.x]), b(g.normals[t.y]), c(g.normals[t.z]);
  const glm::dvec3 n = (1 - barycentrics.x - barycentrics.y) * a + barycentrics.x * b + barycentrics.y * c;
  return glm::dot(n, n) > 0 ? unit(to_world(ref, n)) : geometric;
}

/// Sets magnitude and spread of a triangle. A distance along the normal in an instance's group is divided by the length
/// of what the map makes of the unit normal to be one in the world.
void set_sizes(const PrimitiveRef& ref, Surface& surface) {
  const Corners k = corners(ref);
  const glm::dvec3 ab = k.b - k.a, ac = k.c - k.a, bc = k.c - k.b, n = glm::cross(ab, ac);
  const double area = glm::length(n);
  surface.magnitude = std::max({largest(k.a), largest(k.b), largest(k.c)});
  surface.spread = std::sqrt(glm::dot(ab, ab) * glm::dot(ac, ac) * glm::dot(bc, bc)) / area;
  if (!ref.instance) return;
  const double stretch = area / glm::length(to_world(ref, n));
  surface.magnitude = surface.magnitude * stretch + largest(ref.instance->to_group.origin);
  surface.spread *= stretch;
}

}  // namespace

glm::dvec3 triangle_normal(const Geometry& g, std::uint32_t triangle) {
  const glm::uvec3 t = g.triangles[triangle];
  const glm::dvec3 a = g.vertex(t.x);
  return glm::cross(g.vertex(t.y) - a, g.vertex(t.z) - a);
}

glm::dvec3 quadric_normal(const Geometry& geometry, const Quadric& quadric, const Instance* instance,
                          std::uint32_t part, const glm::dvec3& point) {
  glm::dvec3 normal(0, 0, part == 1 ? -1 : 1);
  if (part == 0) {
    const glm::dvec3 local = quadric.to_object.point(instance ? instance->to_group.point(point) : point);
    normal = gradient(matrix(geometry, quadric), local);
  }
  const glm::dvec3 turned = quadric.to_object.normal_to_world(normal);
  return unit(instance ? instance->to_group.normal_to_world(turned) : turned);
}

Surface surface_at(const Geometry& geometry, const Ray& ray, const Hit& hit) {
  const PrimitiveRef ref = resolve(geometry, hit.object, hit.primitive);
  const Solution s = solve(ref, ray, hit.t);
  Surface result;
  result.position = ray.at(s.t);
  result.normal = geometric_normal(ref, result.position);
  result.shading_normal = shading_normal(ref, s.barycentrics, result.normal);
  if (ref.is_triangle()) set_sizes(ref, result);
  result.magnitude = std::max(result.magnitude, largest(result.position));
  // The position itself is rounded: a product and a sum of numbers no larger than these.
  const double rounding = gamma(2) * (largest(ray.origin) + std::abs(s.t) * largest(ray.direction));
  result.error = (std::isfinite(s.distance) ? s.distance : 0) + 2 * rounding;
  result.material = ref.geometry->objects[ref.object].material;
  result.is_triangle = ref.is_triangle();
  return result;
}

Hit refine(const Geometry& geometry, const Ray& ray, const Hit& hit) {
  const PrimitiveRef ref = resolve(geometry, hit.object, hit.primitive);
  const Solution s = solve(ref, ray, hit.t);
  Hit result = hit;
  result.t = s.t;
  result.error = s.error;
  if (ref.is_triangle())
    result.u = static_cast<float>(s.barycentrics.x), result.v = static_cast<float>(s.barycentrics.y);
  result.normal = glm::vec3(geometric_normal(ref, ray.at(s.t)));
  return result;
}

}  // namespace rayengine
