#include "engine/measure/rays.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "accel/random.h"
#include "engine/render/departure.h"
#include "engine/render/render.h"

namespace rayengine {
namespace {

/// Secondary rays clear what they leave by single precision's needs, so that the same rays suit every tracer.
const Limits single_precision{.triangle_roundoff = 0x1p-24, .quadric_roundoff = 0x1p-24};

/// A hit to leave from, on the side that the ray came from.
struct Leave {
  Departure from;
  glm::dvec3 normal;
};

Leave leave(const Geometry& geometry, const Ray& ray, const Hit& hit) {
  const Surface surface = surface_at(geometry, ray, hit);
  const bool behind = glm::dot(surface.normal, ray.direction) > 0;
  Leave result{{}, behind ? -surface.normal : surface.normal};
  result.from.set(surface, single_precision);
  return result;
}

Ray shadow_ray(const Departure& from, const Light& light) {
  if (light.type == Light::Type::directional) return from.ray(-light.direction, infinity);
  return from.ray(light.position - from.position, 1);
}

struct Sphere {
  glm::dvec3 center;
  double radius;
};

Sphere around(const Box& bounds) {
  const Box box = bounds.finite() ? bounds : Box{glm::dvec3(-1), glm::dvec3(1)};
  return {box.center(), std::max(0.5 * glm::length(box.size()), 1e-30)};
}

}  // namespace

std::vector<Ray> primary_rays(const Camera& camera) {
  std::vector<Ray> rays;
  rays.reserve(static_cast<std::size_t>(camera.size.x) * static_cast<std::size_t>(camera.size.y));
  for (int y = 0; y < camera.size.y; ++y)
    for (int x = 0; x < camera.size.x; ++x) rays.push_back(camera_ray(camera, x + 0.5, y + 0.5));
  return rays;
}

std::vector<Ray> shadow_rays(const Scene& scene, std::span<const Ray> rays, std::span<const Hit> hits) {
  std::vector<Ray> result;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!hits[i].hit()) continue;
    const Leave from = leave(*scene.geometry, rays[i], hits[i]);
    for (const Light& light : scene.lights)
      if (const Ray ray = shadow_ray(from.from, light); glm::dot(ray.direction, from.normal) > 0) result.push_back(ray);
  }
  return result;
}

std::vector<Ray> bounce_rays(const Geometry& geometry, std::span<const Ray> rays, std::span<const Hit> hits,
                             std::uint64_t seed) {
  std::vector<Ray> result;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!hits[i].hit()) continue;
    const Leave from = leave(geometry, rays[i], hits[i]);
    // The normal plus a point of the unit sphere is distributed by the cosine; the two together are never far below it.
    // The seed is turned over lest the numbers be those that random_rays made `rays` of.
    const glm::dvec3 direction = from.normal + (1 - 0x1p-20) * Random(~seed, i).direction();
    result.push_back(from.from.ray(glm::normalize(direction), infinity));
  }
  return result;
}

std::vector<Ray> random_rays(const Box& bounds, std::size_t count, std::uint64_t seed) {
  const Sphere sphere = around(bounds);
  std::vector<Ray> rays;
  rays.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    Random random(seed, i);
    const glm::dvec3 from = sphere.center + sphere.radius * random.direction();
    const glm::dvec3 to = sphere.center + sphere.radius * random.direction();
    rays.push_back({from, 0, glm::normalize(to - from), infinity});
  }
  return rays;
}

}  // namespace rayengine
