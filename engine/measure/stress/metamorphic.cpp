// Row 29: what must not change when a scene and its rays are scaled by a power of two, mirrored, turned by a right
// angle or moved by a power of two. All placements are such that nothing of the scene is rounded.

#include <cmath>

#include "engine/measure/rays.h"
#include "engine/measure/stress/families.h"
#include "engine/measure/stress/shapes.h"

namespace rayengine::stability {
namespace {

/// Bodies at whole places, scaled by powers of two.
std::shared_ptr<const Geometry> exact_scene(const Affine& map, bool quadrics) {
  GeometryBuilder builder;
  int i = 0;
  const auto place = [&] {
    ++i;
    return map * Affine::translate({3 * (i % 4) - 6, 3 * (i / 4) - 4, i % 3}) *
           Affine::scale({i % 2 ? .5 : 1, 1, i % 3 ? 1 : 2});
  };
  if (quadrics) {
    for (const Body& body : bodies()) builder.add(body.shape, 0, place());
  } else {
    for (int k = 0; k < 12; ++k) builder.add(k % 2 ? cube() : fan(5), 0, place());
  }
  return builder.build();
}

Ray moved(const Ray& ray, const Affine& map) {
  return {map.point(ray.origin), ray.tmin, map.vector(ray.direction), ray.tmax};
}

/// Coordinates to 24 bits, so that moving by a thousand leaves them exact.
Ray rounded(Ray ray) {
  const auto round = [](glm::dvec3& v) {
    for (int i = 0; i < 3; ++i) v[i] = std::ldexp(std::round(std::ldexp(v[i], 20)), -20);
  };
  round(ray.origin), round(ray.direction);
  return ray;
}

}  // namespace

Cases metamorphic_cases(std::size_t rays, std::uint64_t seed) {
  const std::pair<const char*, Affine> maps[]{
      {"times 2^40", Affine::scale(glm::dvec3(0x1p40))},
      {"times 2^-40", Affine::scale(glm::dvec3(0x1p-40))},
      {"mirrored in x", Affine::scale({-1, 1, 1})},
      {"mirrored in all axes", Affine::scale({-1, -1, -1})},
      {"axes permuted", {glm::dmat3({0, 1, 0}, {0, 0, 1}, {1, 0, 0}), glm::dvec3(0)}},
      {"moved by 2^10", Affine::translate(glm::dvec3(1024))},
  };
  Cases cases;
  for (const bool quadrics : {true, false}) {
    Case plain{.geometry = exact_scene({}, quadrics)};
    for (const Ray& ray : random_rays(plain.geometry->bounds, rays, seed)) plain.rays.push_back(rounded(ray));
    const auto twin = std::make_shared<const Case>(plain);
    for (const auto& [name, map] : maps) {
      Case c{.variant = (quadrics ? "quadrics, " : "triangles, ") + std::string(name),
             .geometry = exact_scene(map, quadrics)};
      for (const Ray& ray : plain.rays) c.rays.push_back(moved(ray, map));
      c.twin = twin;
      cases.push_back(c);
    }
  }
  return cases;
}

}  // namespace rayengine::stability
