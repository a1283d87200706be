// Forms at their limits: rows 14, 30, 31, 33 and 34.

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "engine/measure/rays.h"
#include "engine/measure/stress/aim.h"
#include "engine/measure/stress/families.h"
#include "engine/measure/stress/shapes.h"
#include "engine/measure/stress/text.h"

namespace rayengine::stability {
namespace {

using std::numbers::pi;
using enum QuadricType;

std::vector<Ray> chords(std::size_t rays, std::uint64_t seed) {
  return random_rays({glm::dvec3(-1), glm::dvec3(1)}, rays, seed);
}

}  // namespace

Cases degenerate_cases(std::size_t rays, std::uint64_t seed) {
  constexpr Box box{glm::dvec3(-2), glm::dvec3(2)};
  const std::pair<const char*, QuadricMatrix> forms[]{
      {"nothing", {}},
      {"constant", {0, 0, 0, 0, 0, 0, 0, 0, 0, 1}},
      {"plane", {0, 0, 0, .5, 0, 0, .25, 0, 1, -.5}},
      {"double plane", {1, 0, 0, 0, 0, 0, 0, 0, 0, 0}},
      {"parallel planes", {1, 0, 0, 0, 0, 0, 0, 0, 0, -.25}},
      {"crossing planes", {1, 0, 0, 0, -1, 0, 0, 0, 0, 0}},
      {"rank 1, tilted", {1, 2, 3, 0, 4, 6, 0, 9, 0, 0}},
      {"imaginary", {1, 0, 0, 0, 1, 0, 0, 1, 0, 1}},
      {"point", {1, 0, 0, 0, 1, 0, 0, 1, 0, 0}},
      {"line", {1, 0, 0, 0, 1, 0, 0, 0, 0, 0}},
      {"flat ellipsoid", {1, 0, 0, 0, 1, 0, 0, 1e20, 0, -1}},
      {"faint quadratic part", {1e-20, 0, 0, 0, 1e-20, 0, 0, 1e-20, .5, -.1}},
  };
  Cases cases;
  for (const auto& [name, form] : forms) {
    cases.push_back({.variant = name, .geometry = alone(of_form(form, box)), .rays = chords(rays, seed)});
    // Some along the axes, where coefficients vanish.
    for (std::size_t i = 0; i < rays; i += 4) {
      glm::dvec3 along(0);
      along[static_cast<int>(i / 4 % 3)] = 1;
      cases.back().rays[i].direction = along;
    }
  }
  return cases;
}

/// From inside, so that only one of the roots is near.
Cases asymptote_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  for (const QuadricType type : {hyperboloid1, hyperboloid2})
    for (const double off : {0., 1e-9, 1e-7, 1e-5, 1e-3}) {
      Case c{.variant = std::string(to_string(type)) + number(", off = ", off),
             .geometry = alone(clipped(type, -1e4, 1e4))};
      c.rays = make_rays(rays, seed, [=](Random& random, std::size_t i) {
        const double angle = random.between(0, 2 * pi), side = i % 2 ? 1 : -1;
        const glm::dvec3 from{random.between(-2, 2), random.between(-2, 2), random.between(-3, 3)};
        return Ray{from, 0, {std::cos(angle), std::sin(angle), side * (1 + random.between(-off, off))}, infinity};
      });
      cases.push_back(c);
    }
  return cases;
}

/// Rays that start an offset away from a straight line of the surface, in its direction or nearly.
Cases ruling_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  for (const QuadricType type : {saddle, hyperboloid1, cylinder})
    for (const double off : {0., 1e-12, 1e-7, 1e-3}) {
      Case c{.variant = std::string(to_string(type)) + number(", off = ", off), .geometry = alone({.type = type})};
      c.rays = make_rays(rays, seed, [=](Random& random, std::size_t i) {
        // Quarters, so that with `off` 0 everything is exact: x = y is a line of the saddle, and so on.
        const double s = i % 2 ? 1 : -1, k = std::round(random.between(-3, 3)) / 4;
        const glm::dvec3 point = type == saddle         ? glm::dvec3(k, s * k, 0)
                                 : type == hyperboloid1 ? glm::dvec3(1, s * k, k)
                                                        : glm::dvec3(s, 0, .5 + k / 2);
        const glm::dvec3 along = type == saddle         ? glm::dvec3(1, s, 0)
                                 : type == hyperboloid1 ? glm::dvec3(0, s, 1)
                                                        : glm::dvec3(0, 0, 1);
        return Ray{point - 4. * along + off * random.direction(), 0, along + off * random.direction(), infinity};
      });
      cases.push_back(c);
    }
  return cases;
}

Cases stretched_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  for (const Body& body : bodies())
    for (const glm::dvec3 by : {glm::dvec3(1, 1, 1e6), glm::dvec3(1e6, 1, 1), glm::dvec3(1e-3, 1e3, 1)}) {
      const Affine map = turned(1) * Affine::scale(by);
      Case c{.variant = body.name + number(" by ", by.x) + number(", ", by.y) + number(", ", by.z),
             .geometry = alone(body.shape, map)};
      c.size = glm::length(c.geometry->bounds.size());
      // Chosen where the body is round, so that hits are as many as misses.
      for (const Ray& ray : at_disc(body.center, body.radius, 4 * body.radius, rays, seed))
        c.rays.push_back(through(map.point(ray.origin), map.point(ray.at(4 * body.radius))));
      cases.push_back(c);
    }
  return cases;
}

Cases rim_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  for (const Body& body : bodies())
    for (const bool tilted : {false, true}) {
      Case c{.variant = body.name + (tilted ? ", tilted" : ""),
             .geometry = alone(body.shape, tilted ? Affine::translate({.1, .2, .3}) * turned(4) : Affine{})};
      c.rays = aimed_rays(*c.geometry, rays, seed);
      // A third of them grazes the clip planes, which are across the axis.
      for (std::size_t i = 0; i < c.rays.size(); i += 3) {
        const glm::dvec3 target = c.rays[i].at(glm::length(c.rays[i].origin));
        c.rays[i].origin.z = target.z + 1e-6 * (c.rays[i].origin.z - target.z);
        c.rays[i].direction = glm::normalize(target - c.rays[i].origin);
      }
      cases.push_back(c);
    }
  return cases;
}

}  // namespace rayengine::stability
