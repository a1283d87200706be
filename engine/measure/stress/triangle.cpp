// Single triangles and boxes: rows 19, 20, 21 and 24.

#include <cmath>
#include <glm/geometric.hpp>

#include "engine/measure/stress/aim.h"
#include "engine/measure/stress/families.h"
#include "engine/measure/stress/shapes.h"
#include "engine/measure/stress/text.h"

namespace rayengine::stability {
namespace {

/// The corner of a triangle with this angle in radians between sides of `a` and `b`.
Mesh skinny(double angle, double a, double b) {
  return {{{0, 0, 0}, {a, 0, 0}, {b * std::cos(angle), b * std::sin(angle), 0}}, {}, {{0, 1, 2}}};
}

/// 1, 0 or -0: slabs multiply by their inverse.
double unit_or_zero(Random& random) {
  const double choices[]{1, -1, 0., -0.};
  return choices[random.below(4)];
}

Ray along_planes(Random& random) {
  const double coordinates[]{-2, -1, -.5, 0, .5, 1, 2};
  glm::dvec3 from, direction(0);
  for (int i = 0; i < 3; ++i) from[i] = coordinates[random.below(7)];
  while (direction == glm::dvec3(0)) direction = {unit_or_zero(random), unit_or_zero(random), unit_or_zero(random)};
  return {from, 0, direction, infinity};
}

}  // namespace

Cases tiny_triangle_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  for (const double size : {2e-4, 1e-6, 1e-15, 1e-19, 1e-23}) {
    Case c{.variant = number("size = ", size), .geometry = alone(corner_triangle(size)), .size = size};
    c.rays = make_rays(rays, seed, [=](Random& random, std::size_t) {
      return Ray{{random.between(-.2, 1) * size, random.between(-.2, 1) * size, 1}, 0, {0, 0, -1}, infinity};
    });
    c.known = {{c.rays.size(), 1}};
    c.rays.push_back({{size / 4, size / 4, 1}, 0, {0, 0, -1}, infinity});
    cases.push_back(c);
  }
  return cases;
}

Cases grazing_cases(std::size_t rays, std::uint64_t seed) {
  constexpr double degree = 0.017453292519943295;
  Cases cases;
  for (const double slope : {1., .01, 1e-4}) {
    Case c{.variant = number("slope = ", slope),
           .geometry = alone(mapped(skinny(.52 * degree, 11.2, 9.7), turned(2))),
           .size = 11.2};
    c.rays = make_rays(rays, seed, [&](Random& random, std::size_t) {
      const glm::dvec3 to = on_triangle(*c.geometry, random, 2);
      glm::dvec3 away = random.direction();
      const glm::dvec3 normal = turned(2).vector({0, 0, 1});
      away += (slope - 1) * glm::dot(away, normal) * normal;  // nearer to the plane
      return through(to + random.between(10, 600) * away, to);
    });
    cases.push_back(c);
  }
  return cases;
}

Cases coplanar_cases(std::size_t rays, std::uint64_t seed) {
  Case c{.variant = "one triangle", .geometry = alone(Mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 1, 2}}})};
  c.rays = make_rays(rays, seed, [](Random& random, std::size_t) {
    const glm::dvec3 from{random.between(-2, 2), random.between(-2, 2), 0};
    return Ray{from, 0, {.25 - from.x, .25 - from.y, 0}, infinity};
  });
  for (std::size_t i = 0; i < c.rays.size(); ++i) c.known.push_back({i, infinity});
  c.known.push_back({c.rays.size(), infinity});
  c.rays.push_back({{-1, .5, 0}, 0, {1, 0, 0}, infinity});
  // Seen through the planes of its neighbours, a closed body must still be met.
  Case cubes{.variant = "faces of a cube", .geometry = alone(cube())};
  cubes.rays = make_rays(rays, seed, [](Random& random, std::size_t i) {
    const double z = i % 2 ? 1 : -1;
    return through({random.between(2, 4), random.between(-2, 2), z}, {random.between(-1, 1), random.between(-1, 1), z});
  });
  return {c, cubes};
}

Cases slab_cases(std::size_t rays, std::uint64_t seed) {
  const Mesh square{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {}, {{0, 1, 2}, {0, 2, 3}}};
  Cases cases;
  const auto add = [&](const char* name, std::shared_ptr<const Geometry> geometry) {
    cases.push_back({.variant = name, .geometry = std::move(geometry)});
    cases.back().rays = make_rays(rays, seed, [](Random& random, std::size_t) { return along_planes(random); });
  };
  add("cube", alone(cube()));
  add("square without thickness", alone(square));
  add("disk", alone({.type = QuadricType::disk}));
  add("cylinder, capped", alone({.type = QuadricType::cylinder, .capped = true}));
  add("saddle", alone({.type = QuadricType::saddle}));
  add("general in a box", alone(of_form({1, 0, 0, 0, 1, 0, 0, 1, 0, -1.5}, {glm::dvec3(-1), glm::dvec3(1)})));
  return cases;
}

}  // namespace rayengine::stability
