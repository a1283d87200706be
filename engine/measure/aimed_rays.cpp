#include <algorithm>
#include <glm/geometric.hpp>

#include "accel/kernels/kernels.h"
#include "accel/random.h"
#include "engine/measure/rays.h"

namespace rayengine {
namespace {

/// What a ray is aimed at: it passes the point, and in this direction unless it is zero.
struct Target {
  glm::dvec3 point{0};
  glm::dvec3 along{0};
};

Target moved(const Target& target, const Affine& map) { return {map.point(target.point), map.vector(target.along)}; }

Target on_triangle(const Geometry& geometry, std::size_t triangle, Random& random) {
  const glm::uvec3& index = geometry.triangles[triangle];
  const std::size_t corner = random.below(3);
  const glm::dvec3 a = geometry.vertex(index[static_cast<int>(corner)]);
  const glm::dvec3 b = geometry.vertex(index[static_cast<int>((corner + 1) % 3)]);
  return {random.below(3) == 0 ? a : a + random.unit() * (b - a), {}};
}

QuadricMatrix matrix_of(const Geometry& geometry, const Quadric& q) {
  // A disk's outline is where a cylinder passes its plane.
  if (q.type == QuadricType::disk) return unit_matrix(QuadricType::cylinder);
  return q.type == QuadricType::general ? geometry.forms[q.form].matrix : unit_matrix(q.type);
}

glm::dvec3 gradient(const QuadricMatrix& m, const glm::dvec3& p) {
  return {m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[1] * p.x + m[4] * p.y + m[5] * p.z + m[6],
          m[2] * p.x + m[5] * p.y + m[7] * p.z + m[8]};
}

/// One of the clip planes, or a height between them, where unbounded ones count as -1 and 1.
double height(const Geometry& geometry, const Quadric& q, Random& random) {
  if (q.type == QuadricType::disk || q.type == QuadricType::plane) return 0;
  const bool general = q.type == QuadricType::general;
  const double below = general ? geometry.forms[q.form].box.lower.z : q.zmin;
  const double above = general ? geometry.forms[q.form].box.upper.z : q.zmax;
  const std::size_t choice = random.below(4);
  if (choice == 0 && std::isfinite(below)) return below;
  if (choice == 1 && std::isfinite(above)) return above;
  return random.between(std::isfinite(below) ? below : -1, std::isfinite(above) ? above : 1);
}

/// Where a random line at height z passes the surface, or a random point when it does not.
glm::dvec3 surface_point(const QuadricMatrix& m, double z, Random& random) {
  const double angle = random.between(0, 2 * std::numbers::pi);
  const kernels::Vec3<double> p{random.between(-1, 1), random.between(-1, 1), z},
      d{std::cos(angle), std::sin(angle), 0};
  double a, b, c, near, far;
  kernels::general_coefficients(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8], m[9], p, d, a, b, c);
  kernels::roots(a, b, c, near, far);
  const double t = std::abs(near) < 1e100 ? near : 0;
  return {p.x + t * d.x, p.y + t * d.y, z};
}

/// A rim or any point of the surface, passed anyhow; or a point passed along a tangent: a silhouette.
Target on_quadric(const Geometry& geometry, const Quadric& q, Random& random) {
  const QuadricMatrix m = matrix_of(geometry, q);
  Target target{surface_point(m, height(geometry, q, random), random), {}};
  if (random.below(2) == 0) target.along = glm::cross(gradient(m, target.point), random.direction());
  return moved(target, object_to_world(q.to_object));
}

Target target_in(const Geometry& geometry, Random& random) {
  const std::size_t triangles = geometry.triangles.size(), quadrics = geometry.quadrics.size();
  const std::size_t i = random.below(triangles + quadrics + geometry.instances.size());
  if (i < triangles) return on_triangle(geometry, i, random);
  if (i < triangles + quadrics) return on_quadric(geometry, geometry.quadrics[i - triangles], random);
  const Instance& instance = geometry.instances[i - triangles - quadrics];
  return moved(target_in(*geometry.groups[instance.group], random), object_to_world(instance.to_group));
}

Ray aimed(const Target& target, double distance, Random& random) {
  const double length = glm::length(target.along);
  const glm::dvec3 along = length > 0 ? target.along / length : random.direction();
  const glm::dvec3 from = target.point - random.between(0.5, 2) * distance * along;
  return {from, 0, glm::normalize(target.point - from), infinity};
}

}  // namespace

std::vector<Ray> aimed_rays(const Geometry& geometry, std::size_t count, std::uint64_t seed) {
  std::vector<Ray> rays;
  if (geometry.objects.empty()) return rays;
  rays.reserve(count);
  const double distance = geometry.bounds.finite() ? std::max(glm::length(geometry.bounds.size()), 1e-30) : 4;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(seed, i);
    rays.push_back(aimed(target_in(geometry, random), distance, random));
  }
  return rays;
}

}  // namespace rayengine
