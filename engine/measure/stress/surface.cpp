// Rays that leave surfaces, and surfaces that lie close together: rows 13 and 23.

#include <glm/geometric.hpp>

#include "cpu/reference_tracer.h"
#include "engine/measure/rays.h"
#include "engine/measure/stress/aim.h"
#include "engine/measure/stress/families.h"
#include "engine/measure/stress/shapes.h"
#include "engine/measure/stress/text.h"

namespace rayengine::stability {
namespace {

/// From points of the surface, rounded to double, in any direction: what is right depends on the rounding.
std::vector<Ray> from_rounded_points(const std::vector<Spot>& places, std::size_t rays, std::uint64_t seed) {
  return make_rays(rays, seed, [&](Random& random, std::size_t i) {
    return Ray{places[i % places.size()].point, 0, random.direction(), infinity};
  });
}

/// As bounce_rays starts them: no outward ray meets what it left.
std::vector<Ray> as_a_renderer(const std::shared_ptr<const Geometry>& geometry, std::size_t rays, std::uint64_t seed) {
  const std::vector<Ray> chords = random_rays(geometry->bounds, 4 * rays, seed);
  std::vector<Hit> hits(chords.size());
  make_reference_tracer(geometry)->closest(chords, hits, RayClass::bounce);
  std::vector<Ray> bounces = bounce_rays(*geometry, chords, hits, seed);
  if (bounces.size() > rays) bounces.resize(rays);
  return bounces;
}

void add_leaving(Cases& cases, const std::string& name, const std::shared_ptr<const Geometry>& geometry,
                 std::size_t rays, std::uint64_t seed) {
  const std::vector<Spot> places = spots(geometry, std::max<std::size_t>(rays, 1), seed);
  cases.push_back({.variant = name + ", as rounded", .geometry = geometry});
  cases.back().rays = from_rounded_points(places, rays, seed);
  cases.push_back({.variant = name + ", as rendered", .geometry = geometry});
  cases.back().rays = as_a_renderer(geometry, rays, seed);
}

}  // namespace

Cases leaving_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  for (const Body& body : bodies()) add_leaving(cases, body.name, alone(body.shape, turned(2)), rays, seed);
  add_leaving(cases, "mesh", alone(uv_sphere(16, 32), turned(2)), rays, seed);
  return cases;
}

Cases nested_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  const auto add = [&](const std::string& name, const auto& shape, double radius, double gap) {
    GeometryBuilder builder;
    builder.add(shape, 0, Affine::scale(glm::dvec3(1 + gap)));  // the outer one has the lower id
    builder.add(shape);
    Case c{.variant = name + number(", gap = ", gap), .geometry = builder.build(), .size = radius};
    c.rays = at_disc(c.geometry->bounds.center(), radius, 4 * radius, rays, seed);
    cases.push_back(c);
  };
  for (const double gap : {0., 4e-5, 1e-7, 1e-10, 1e-14}) {
    for (const Body& body : bodies()) add(body.name, body.shape, body.radius, gap);
    add("mesh", uv_sphere(16, 32), 1, gap);
  }
  return cases;
}

}  // namespace rayengine::stability
