#include "engine/measure/stress/aim.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "accel/surface.h"
#include "cpu/reference_tracer.h"
#include "engine/measure/rays.h"

namespace rayengine::stability {

std::vector<Ray> make_rays(std::size_t count, std::uint64_t seed, const MakeRay& make) {
  std::vector<Ray> rays;
  rays.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    Random random(seed, i);
    rays.push_back(make(random, i));
  }
  return rays;
}

Ray through(const glm::dvec3& from, const glm::dvec3& to) { return {from, 0, glm::normalize(to - from), infinity}; }

glm::dvec3 across(const glm::dvec3& direction, Random& random) {
  glm::dvec3 side = glm::cross(direction, random.direction());
  while (glm::dot(side, side) == 0) side = glm::cross(direction, random.direction());
  return glm::normalize(side);
}

std::vector<Ray> at_disc(const glm::dvec3& center, double radius, double distance, std::size_t count,
                         std::uint64_t seed) {
  return make_rays(count, seed, [=](Random& random, std::size_t) {
    const glm::dvec3 away = random.direction();
    const glm::dvec3 aside = radius * std::sqrt(random.unit()) * across(away, random);
    return through(center + distance * away, center + aside);
  });
}

std::vector<Ray> at_points(const std::vector<glm::dvec3>& points, double distance, std::size_t count,
                           std::uint64_t seed) {
  return make_rays(count, seed, [&](Random& random, std::size_t i) {
    const glm::dvec3& point = points[i % points.size()];
    return through(point + distance * random.direction(), point);
  });
}

glm::dvec3 on_triangle(const Geometry& geometry, Random& random, std::size_t turn) {
  const glm::uvec3& index = geometry.triangles[random.below(geometry.triangles.size())];
  const glm::dvec3 a = geometry.vertex(index.x), b = geometry.vertex(index.y), c = geometry.vertex(index.z);
  const glm::dvec3 on_edge = a + random.unit() * (b - a);
  return turn % 3 == 0 ? on_edge : turn % 3 == 1 ? a : on_edge + random.unit() * (c - on_edge);
}

std::vector<Spot> spots(const std::shared_ptr<const Geometry>& geometry, std::size_t count, std::uint64_t seed) {
  const std::vector<Ray> rays = random_rays(geometry->bounds, 4 * count + 256, seed);
  std::vector<Hit> hits(rays.size());
  make_reference_tracer(geometry)->closest(rays, hits, RayClass::bounce);
  std::vector<Spot> found;
  for (std::size_t i = 0; i < rays.size() && found.size() < count; ++i) {
    if (!hits[i].hit()) continue;
    const Surface surface = surface_at(*geometry, rays[i], hits[i]);
    const bool behind = glm::dot(surface.normal, rays[i].direction) > 0;
    found.push_back({surface.position, behind ? -surface.normal : surface.normal});
  }
  if (found.empty()) throw Error("no chord meets the scene: nothing to leave from");
  return found;
}

}  // namespace rayengine::stability
