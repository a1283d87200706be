#include "engine/measure/doubt.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>

#include "accel/frame.h"
#include "accel/surface.h"

namespace rayengine {
namespace {

Ray with_interval(Ray ray, double widening) {
  ray.tmin -= widening;
  ray.tmax = std::max(ray.tmax + widening, ray.tmin);
  return ray;
}

/// The same triangle, or parts of one quadric: those meet at rims, and tracers test them one by one.
bool same_surface(const Geometry& geometry, const Hit& a, const Hit& b) {
  if (!a.hit() || a.object != b.object) return false;
  if (a.primitive == b.primitive) return true;
  const PrimitiveRef p = resolve(geometry, a.object, a.primitive), q = resolve(geometry, b.object, b.primitive);
  return !p.is_triangle() && p.geometry == q.geometry && p.instance == q.instance && p.object == q.object;
}

/// Whether t lies among those of the neighbours, which spread widely where a surface is seen at a grazing angle.
bool t_explained(const Doubt& doubt, std::span<const Hit> answers) {
  const auto [low, high] =
      std::minmax_element(answers.begin(), answers.end(), [](const Hit& a, const Hit& b) { return a.t < b.t; });
  const double slack = in_t(doubt.bound, doubt.ray, doubt.exact) + doubt.exact.error;
  return low->t - slack <= doubt.hit.t && doubt.hit.t <= high->t + slack;
}

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

double distance_to_segment(const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 edge = b - a;
  const double length = glm::dot(edge, edge),
               along = length > 0 ? glm::clamp(-glm::dot(a, edge) / length, 0.0, 1.0) : 0;
  return glm::length(a + along * edge);
}

/// The distance of the origin from a triangle in the plane.
double distance_to_triangle(const std::array<glm::dvec2, 3>& k) {
  const double a = cross(k[1], k[2]), b = cross(k[2], k[0]), c = cross(k[0], k[1]);
  if ((a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0)) return 0;
  return std::min({distance_to_segment(k[0], k[1]), distance_to_segment(k[1], k[2]), distance_to_segment(k[2], k[0])});
}

/// The distance of the ray's line from a triangle, measured across the ray.
double distance(const Ray& ray, const PrimitiveRef& ref) {
  const glm::dmat3 frame = frame_about(glm::normalize(ray.direction));
  const glm::uvec3& index = ref.geometry->triangles[ref.triangle()];
  std::array<glm::dvec2, 3> seen;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 corner = ref.geometry->vertex(index[i]);
    const glm::dvec3 from =
        (ref.instance ? object_to_world(ref.instance->to_group).point(corner) : corner) - ray.origin;
    seen[static_cast<std::size_t>(i)] = {glm::dot(from, frame[0]), glm::dot(from, frame[1])};
  }
  return distance_to_triangle(seen);
}

bool triangle_explained(const Doubt& doubt, const Geometry& geometry, const PrimitiveRef& ref) {
  const Hit plane = refine(geometry, doubt.ray, doubt.hit);
  return distance(doubt.ray, ref) <= doubt.bound &&
         std::abs(plane.t - doubt.hit.t) <= in_t(doubt.bound, doubt.ray, plane) + plane.error;
}

/// Whether neighbours meet the quadric near the stated t, be it behind another surface at nearly the same place.
bool quadric_explained(const Doubt& doubt, double part, const Geometry& geometry, Tracer& oracle) {
  double low = infinity, high = -infinity;
  for (const Hit& a : oracle.all(neighbours(doubt, part)).hits) {
    if (!same_surface(geometry, a, doubt.hit)) continue;
    const double slack = in_t(doubt.bound, doubt.ray, a) + a.error;
    low = std::min(low, a.t - slack);
    high = std::max(high, a.t + slack);
  }
  return low <= doubt.hit.t && doubt.hit.t <= high;
}

/// Whether the oracle sees something nearer along the ray and along all of its neighbours.
bool hidden(const Doubt& doubt, std::span<const Hit> answers) {
  return std::all_of(answers.begin(), answers.end(), [&](const Hit& a) {
    return a.hit() && a.t + in_t(doubt.bound, doubt.ray, a) + a.error < doubt.hit.t;
  });
}

}  // namespace

double in_t(double bound, const Ray& ray, const Hit& hit) {
  const double slope = std::abs(glm::dot(glm::dvec3(hit.normal), ray.direction));
  return slope > 0 ? bound / slope : infinity;
}

std::vector<Ray> neighbours(const Doubt& doubt, double part) {
  const Ray& ray = doubt.ray;
  const double length = glm::length(ray.direction), step = doubt.bound / length;
  const double t = std::min(doubt.hit.t, doubt.exact.t);
  const glm::dmat3 frame = frame_about(ray.direction / length);
  std::vector<Ray> rays{with_interval(ray, step), with_interval(ray, -step)};
  for (int i = 0; i < 8; ++i) {
    const double angle = i * std::numbers::pi / 4;
    const glm::dvec3 move = part * doubt.bound * (std::cos(angle) * frame[0] + std::sin(angle) * frame[1]);
    Ray shifted = ray, turned = ray;
    shifted.origin += move;
    if (t > 0) turned.direction += move / t;
    rays.insert(rays.end(), {with_interval(shifted, step), with_interval(shifted, -step), turned});
  }
  return rays;
}

bool explained(const Doubt& doubt, double part, std::span<const Hit> answers, const Geometry& geometry,
               Tracer& oracle) {
  const Hit &hit = doubt.hit, &exact = doubt.exact;
  if (!hit.hit()) return std::any_of(answers.begin(), answers.end(), [](const Hit& a) { return !a.hit(); });
  if (hit.object == exact.object && hit.primitive == exact.primitive) return t_explained(doubt, answers);
  if (hidden(doubt, answers)) return false;
  const PrimitiveRef ref = resolve(geometry, hit.object, hit.primitive);
  return ref.is_triangle() ? triangle_explained(doubt, geometry, ref)
                           : quadric_explained(doubt, part, geometry, oracle);
}

}  // namespace rayengine
