#include "cpu/reference/candidates.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "cpu/reference/quadric.h"
#include "cpu/reference/triangle.h"

namespace rayengine::reference {
namespace {

Root exact_t(const Ray& ray, const Candidate& c) {
  const auto world = make_line<Exact>(ray);
  const auto line = c.instance ? transformed(world, c.instance->to_group) : world;
  return c.is_triangle ? exact_t(line, *c.geometry, c.index)
                       : exact_t(line, *c.geometry, c.geometry->quadrics[c.index], c.at);
}

/// The sign of candidate's t - bound.
int compare_t(const Ray& ray, const Candidate& c, double bound) {
  const quad difference = c.at.t - bound;
  if (std::isinf(bound) || size_of(difference) > c.at.error) return sign(difference);
  return compare(exact_t(ray, c), Exact(bound), Exact(1));
}

/// Whether two triangles, of which scanned meshes have some, are one: then t is, too.
bool same_corners(const Candidate& a, const Candidate& b) {
  if (a.geometry != b.geometry || a.instance != b.instance) return false;
  const glm::uvec3 s = a.geometry->triangles[a.index], t = b.geometry->triangles[b.index];
  return std::is_permutation(&s[0], &s[0] + 3, &t[0]);
}

Vector<quad> to_world(const Vector<quad>& n, const WorldToObject& map) { return glm::transpose(map.linear) * n; }

glm::vec3 unit(const Vector<quad>& v) {
  const quad largest = std::max({v.x < 0 ? -v.x : v.x, v.y < 0 ? -v.y : v.y, v.z < 0 ? -v.z : v.z});
  const quad x = v.x / largest, y = v.y / largest, z = v.z / largest, length = sqrtq(x * x + y * y + z * z);
  return {static_cast<float>(x / length), static_cast<float>(y / length), static_cast<float>(z / length)};
}

Vector<quad> normal_in_group(const LocalRay& ray, const Candidate& c) {
  if (c.is_triangle) return normal(*c.geometry, c.index);
  const Quadric& q = c.geometry->quadrics[c.index];
  return to_world(normal(LocalRay(ray, q.to_object), *c.geometry, q, c.at), q.to_object);
}

}  // namespace

bool in_interval(const Ray& ray, const Candidate& c) {
  const bool representable = static_cast<double>(c.at.t) < infinity;
  return representable && compare_t(ray, c, ray.tmin) > 0 && compare_t(ray, c, ray.tmax) <= 0;
}

int compare_t(const Ray& ray, const Candidate& a, const Candidate& b) {
  const quad difference = a.at.t - b.at.t;
  if (size_of(difference) > a.at.error + b.at.error) return sign(difference);
  const bool triangles = a.is_triangle && b.is_triangle;
  if (triangles && same_corners(a, b)) return 0;
  const Root s = exact_t(ray, a), t = exact_t(ray, b);
  return triangles || (is_moderate(s) && is_moderate(t)) ? compare(s, t) : sign(difference);
}

bool before(const Ray& ray, const Candidate& a, const Candidate& b) {
  const int order = compare_t(ray, a, b);
  return order < 0 || (order == 0 && std::tie(a.object, a.primitive) < std::tie(b.object, b.primitive));
}

bool owns(const Ray& ray, const Candidate& c, const ClosedMeshes& closed) {
  if (!c.is_triangle) return c.at.counts;
  if (!closed.contains(*c.geometry, c.geometry->triangle_object[c.index])) return true;
  const LocalRay world(ray);
  return c.instance ? owns_crossing(LocalRay(world, c.instance->to_group), *c.geometry, c.index)
                    : owns_crossing(world, *c.geometry, c.index);
}

Hit describe(const Ray& ray, const Candidate& c) {
  const LocalRay world(ray);
  const std::optional<LocalRay> placed =
      c.instance ? std::optional<LocalRay>(std::in_place, world, c.instance->to_group) : std::nullopt;
  const LocalRay& local = placed ? *placed : world;
  Hit hit{.t = static_cast<double>(c.at.t), .object = c.object, .primitive = c.primitive, .status = status_hit};
  hit.error = static_cast<double>((c.at.error + 0x1p-53L * size_of(c.at.t)) * (1 + 0x1p-50L)) + 0x1p-1074;
  const Vector<quad> n = normal_in_group(local, c);
  hit.normal = unit(c.instance ? to_world(n, c.instance->to_group) : n);
  if (!c.is_triangle) return hit;
  const auto [u, v] = barycentrics(local, *c.geometry, c.index);
  hit.u = static_cast<float>(u);
  hit.v = static_cast<float>(v);
  return hit;
}

}  // namespace rayengine::reference
