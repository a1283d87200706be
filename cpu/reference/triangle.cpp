#include "cpu/reference/triangle.h"

namespace rayengine::reference {
namespace {

/// Corners as seen from the origin of a ray.
template <class T>
struct Corners {
  Vector<T> a, b, c;
};

template <class T>
Corners<T> corners(const Vector<T>& from, const Geometry& geometry, std::uint32_t triangle) {
  const glm::uvec3& index = geometry.triangles[triangle];
  return {make_vector<T>(geometry.vertex(index.x)) - from, make_vector<T>(geometry.vertex(index.y)) - from,
          make_vector<T>(geometry.vertex(index.z)) - from};
}

/// Six times the signed volumes opposite to the corners a, b and c, in this order.
template <class T>
std::array<T, 3> volumes(const Line<T>& ray, const Corners<T>& k) {
  return {dot(ray.direction, cross(k.b, k.c)), dot(ray.direction, cross(k.c, k.a)),
          dot(ray.direction, cross(k.a, k.b))};
}

/// t of the plane is the first over the second: a . n and d . n, as the three cross products add up to n.
template <class T>
std::array<T, 2> plane_t(const Line<T>& ray, const Corners<T>& k) {
  const std::array<T, 3> v = volumes(ray, k);
  return {dot(k.a, cross(k.b, k.c)), v[0] + v[1] + v[2]};
}

std::array<Estimate, 3> estimated_volumes(const LocalRay& ray, const Geometry& geometry, std::uint32_t triangle) {
  return estimate<3>(
      ray, [&]<class T>(const Line<T>& line) { return volumes(line, corners(line.origin, geometry, triangle)); });
}

bool passes(const std::array<Estimate, 3>& v) {
  const bool positive = v[0].value > 0 || v[1].value > 0 || v[2].value > 0;
  const bool negative = v[0].value < 0 || v[1].value < 0 || v[2].value < 0;
  return positive != negative;
}

/// The sign of a vector's first component that is not zero.
int first_sign(const Vector<Exact>& v) {
  for (const Exact* component : {&v.x, &v.y, &v.z})
    if (component->sign() != 0) return component->sign();
  return 0;
}

}  // namespace

bool owns_crossing(const LocalRay& ray, const Geometry& geometry, std::uint32_t triangle) {
  const std::array<Estimate, 3> v = estimated_volumes(ray, geometry, triangle);
  if (v[0].value != 0 && v[1].value != 0 && v[2].value != 0) return passes(v);
  const Line<Exact> line = ray.exact();
  const Corners<Exact> k = corners(line.origin, geometry, triangle);
  const Vector<Exact> edges[] = {k.c - k.b, k.a - k.c, k.b - k.a};
  int sum = 0;
  for (int i = 0; i < 3; ++i)
    sum += v[i].value > 0 ? 1 : v[i].value < 0 ? -1 : first_sign(cross(line.direction, edges[i]));
  return sum == 3 || sum == -3;
}

std::optional<Crossing> cross_triangle(const LocalRay& ray, const Geometry& geometry, std::uint32_t triangle) {
  if (!passes(estimated_volumes(ray, geometry, triangle))) return std::nullopt;
  const auto [n, d] = estimate<2>(
      ray, [&]<class T>(const Line<T>& line) { return plane_t(line, corners(line.origin, geometry, triangle)); });
  const quad t = n.value / d.value;
  return Crossing{t, (n.error + size_of(t) * d.error) / size_of(d.value) + quad_rounding * size_of(t)};
}

Root exact_t(const Line<Exact>& ray, const Geometry& geometry, std::uint32_t triangle) {
  const auto [n, d] = plane_t(ray, corners(ray.origin, geometry, triangle));
  return fraction(n, d);
}

std::array<double, 2> barycentrics(const LocalRay& ray, const Geometry& geometry, std::uint32_t triangle) {
  const auto [a, b, c] = estimated_volumes(ray, geometry, triangle);
  const quad sum = a.value + b.value + c.value;
  return {static_cast<double>(b.value / sum) + 0, static_cast<double>(c.value / sum) + 0};  // no negative zeros
}

Vector<quad> normal(const Geometry& geometry, std::uint32_t triangle) {
  const auto k = corners(Vector<quad>{0, 0, 0}, geometry, triangle);
  return cross(k.b - k.a, k.c - k.a);
}

}  // namespace rayengine::reference
