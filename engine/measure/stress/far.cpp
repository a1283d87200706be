// Distance, size and place: rows 1, 3, 4, 5 and 22.

#include <cmath>
#include <glm/geometric.hpp>

#include "engine/measure/stress/aim.h"
#include "engine/measure/stress/families.h"
#include "engine/measure/stress/shapes.h"
#include "engine/measure/stress/text.h"

namespace rayengine::stability {
namespace {

constexpr double aimed_beyond = 1.2;  // of the radius: so that both hits and misses are met

}  // namespace

Cases far_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  for (const Body& body : bodies())
    for (const double distance : {1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7})
      cases.push_back({.variant = body.name + number(", D = ", distance),
                       .geometry = alone(body.shape),
                       .rays = at_disc(body.center, aimed_beyond * body.radius, distance * body.radius, rays, seed),
                       .size = body.radius,
                       .distance = distance});
  return cases;
}

Cases planet_cases(std::size_t rays, std::uint64_t seed) {
  constexpr double radius = 6371000, eye = 2;
  Cases cases;
  for (const Body& body : bodies()) {
    Case planet{.variant = body.name, .geometry = alone(body.shape, Affine::scale(glm::dvec3(radius)))};
    planet.size = eye;
    const std::vector<Spot> places = spots(planet.geometry, std::max<std::size_t>(rays, 1), seed);
    planet.rays = make_rays(rays, seed, [&](Random& random, std::size_t i) {
      const Spot& spot = places[i % places.size()];
      const double angle = random.between(0, 1.57);
      const glm::dvec3 aside = across(spot.normal, random);
      return Ray{spot.point + eye * spot.normal, 0, std::sin(angle) * aside - std::cos(angle) * spot.normal, infinity};
    });
    if (body.shape.type == QuadricType::sphere) {
      const double angles[]{0, .5, 1, 1.4}, expected[]{2, 2.278988, 3.701633, 11.767042};
      for (int i = 0; i < 4; ++i) {
        planet.known.push_back({planet.rays.size(), expected[i], 1e-6});
        planet.rays.push_back({{0, 0, radius + eye}, 0, {std::sin(angles[i]), 0, -std::cos(angles[i])}, infinity});
      }
    }
    cases.push_back(planet);
  }
  return cases;
}

Cases small_and_far_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  for (const QuadricType type : {QuadricType::sphere, QuadricType::cylinder, QuadricType::hyperboloid1})
    for (const double radius : {.1, .01, .001})
      for (const double distance : {1e5, 1e6, 1e7}) {
        Case c{.variant = std::string(to_string(type)) + number(", r = ", radius) + number(", D = ", distance),
               .geometry = alone(QuadricShape{.type = type}, Affine::scale(glm::dvec3(radius))),
               .size = radius};
        // Waists of radius 1 at z = 0 but for the cylinder, which is one everywhere.
        const double z = type == QuadricType::cylinder ? .5 * radius : 0;
        c.rays = make_rays(rays, seed, [=](Random& random, std::size_t i) {
          const double aside = radius * (i == 0 ? .95 : random.between(-.95, .95));
          return Ray{{-distance, aside, z}, 0, {1, 0, 0}, infinity};
        });
        if (rays > 0) c.known = {{0, distance, 1e-5 * radius}};
        cases.push_back(c);
      }
  return cases;
}

Cases scale_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  for (const Body& body : bodies())
    for (const double scale : {1e-30, 1e-20, 1e-15, 1e15, 1e20, 1e30}) {
      Case c{.variant = body.name + number(" times ", scale),
             .geometry = alone(body.shape, Affine::scale(glm::dvec3(scale))),
             .rays = at_disc(body.center, aimed_beyond * body.radius, 4 * body.radius, rays, seed),
             .size = scale * body.radius};
      if (body.shape.type == QuadricType::sphere) {
        c.known = {{c.rays.size(), scale * (4 - std::sqrt(.75)), 1e-15}};
        c.rays.push_back({{-4, .5, 0}, 0, {1, 0, 0}, infinity});
      }
      for (Ray& ray : c.rays) ray.origin *= scale;
      cases.push_back(c);
    }
  return cases;
}

Cases offset_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  for (const glm::dvec3 offset :
       {glm::dvec3(1e4), glm::dvec3(5e5, 0, 0), glm::dvec3(8e5, -8e5, 3), glm::dvec3(4.5e6, 6e6, 0), glm::dvec3(1e7)}) {
    const Affine there = Affine::translate(offset);
    const auto add = [&](const std::string& name, std::shared_ptr<const Geometry> geometry, double radius) {
      Case c{.variant = name + number(" at ", glm::length(offset)), .geometry = std::move(geometry), .size = radius};
      c.rays = at_disc(c.geometry->bounds.center(), aimed_beyond * radius, 4 * radius, rays, seed);
      cases.push_back(c);
    };
    for (const Body& body : bodies()) add(body.name, alone(body.shape, there), body.radius);
    add("mesh", alone(uv_sphere(16, 32), there), 1);
  }
  return cases;
}

}  // namespace rayengine::stability
