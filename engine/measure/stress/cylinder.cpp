// Bodies with an axis, and rays along it: rows 9 to 12.

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "engine/measure/stress/aim.h"
#include "engine/measure/stress/families.h"
#include "engine/measure/stress/shapes.h"
#include "engine/measure/stress/text.h"

namespace rayengine::stability {
namespace {

using std::numbers::pi;
using enum QuadricType;

/// A point at this distance from the z axis, anywhere around it.
glm::dvec3 around(double radius, double z, Random& random) {
  const double angle = random.between(0, 2 * pi);
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

Ray tilted(Random& random, double z, double tilt) {
  const glm::dvec3 aside = std::sin(tilt) * around(1, 0, random);
  return {around(random.between(.05, .95), z, random), 0, {aside.x, aside.y, std::cos(tilt)}, infinity};
}

/// To the line that ends at `from` and `to`, from the z axis between 0 and 1.
Affine from_axis(const glm::dvec3& from, const glm::dvec3& to, double radius) {
  const glm::dvec3 along = to - from, unit = glm::normalize(along);
  const double degrees = std::acos(unit.z) * 180 / pi;
  return Affine::translate(from) * Affine::rotate(glm::cross(glm::dvec3(0, 0, 1), unit), degrees) *
         Affine::scale({radius, radius, glm::length(along)});
}

}  // namespace

Cases near_axis_cases(std::size_t rays, std::uint64_t seed) {
  struct Tube {
    const char* name;
    QuadricShape shape;
    double z;  ///< where rays start, inside
  };
  const Tube tubes[]{{"cylinder", clipped(cylinder, -1e7, 1e7), 0},
                     {"paraboloid", clipped(paraboloid, 0, 1e7), 4},
                     {"cone", clipped(cone, -1e7, 1e7), 4},
                     {"hyperboloid1", clipped(hyperboloid1, -1e7, 1e7), 0},
                     {"hyperboloid2", clipped(hyperboloid2, -1e7, 1e7), 4}};
  Cases cases;
  for (const Tube& tube : tubes)
    for (double tilt = 1e-1; tilt > .5e-6; tilt /= 10) {
      Case c{.variant = tube.name + number(", tilt = ", tilt), .geometry = alone(tube.shape)};
      c.rays = make_rays(rays, seed, [&](Random& random, std::size_t) { return tilted(random, tube.z, tilt); });
      if (tube.shape.type == cylinder) {
        c.known = {{c.rays.size(), .5 / std::sin(tilt), 1e-14}};
        c.rays.push_back({{.5, 0, 0}, 0, {std::sin(tilt), 0, std::cos(tilt)}, infinity});
      }
      cases.push_back(c);
    }
  return cases;
}

Cases along_axis_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  for (const Body& body : bodies()) {
    Case c{.variant = body.name, .geometry = alone(body.shape)};
    c.rays = make_rays(rays, seed, [](Random& random, std::size_t i) {
      const double side = i % 2 ? 1 : -1;
      const glm::dvec3 on_wall[]{{1, 0, 0}, {0, -1, 0}, {0, 0, 0}, {-1, 0, 0}};
      const glm::dvec3 from = i % 3 == 0   ? on_wall[random.below(4)]
                              : i % 3 == 1 ? around(random.between(0, 1), 0, random)
                                           : around(random.between(1, 1.5), 0, random);
      return Ray{{from.x, from.y, -4 * side}, 0, {0, 0, side}, infinity};
    });
    cases.push_back(c);
  }
  return cases;
}

Cases long_body_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  for (const double length : {1e3, 1e4, 1e5}) {
    const std::pair<const char*, Affine> bodies[]{
        {"cylinder", Affine::scale({1, 1, length})},
        {"cylinder across the axes", turned(3) * Affine::scale({1, 1, length})}};
    for (const auto& [name, map] : bodies) {
      Case c{.variant = name + number(", length = ", length), .geometry = alone(QuadricShape{.type = cylinder}, map)};
      c.rays = make_rays(rays, seed, [map = map](Random& random, std::size_t) {
        const double z = random.between(.01, .99), aside = random.between(-1.2, 1.2);
        const glm::dvec3 from = map.point({aside, 10, z}), to = map.point({aside, 0, z});
        return through(from, to);
      });
      c.known = {{c.rays.size(), 9, 1e-10}};
      c.rays.push_back({map.point({0, 10, .5}), 0, map.vector({0, -1, 0}), infinity});
      cases.push_back(c);
    }
    Case spike{.variant = number("cone, length = ", length),
               .geometry = alone(QuadricShape{.type = cone}, Affine::scale({1, 1, length}))};
    spike.rays = make_rays(rays, seed, [=](Random& random, std::size_t) {
      const double z = random.between(0, 1);
      return through({random.between(-3, 3), 10, z * length}, {random.between(-1.2, 1.2) * z, 0, z * length});
    });
    cases.push_back(spike);
  }
  return cases;
}

Cases tilted_axis_cases(std::size_t rays, std::uint64_t seed) {
  const glm::dvec3 from{-30.005, -77.1061, -16.8721}, to{-30.005, -27.301, 16.8721}, along{0, .827878, .560908};
  Cases cases;
  for (const bool capped : {false, true}) {
    Case c{.variant = capped ? "cylinder, capped" : "cylinder",
           .geometry = alone(QuadricShape{.type = cylinder, .capped = capped}, from_axis(from, to, 1))};
    c.rays = make_rays(rays, seed, [&](Random& random, std::size_t i) {
      const double radius = i % 3 == 0 ? 1 : random.between(0, 1.5);
      return Ray{from - 20. * along + radius * across(along, random), 0, along, infinity};
    });
    cases.push_back(c);
  }
  return cases;
}

}  // namespace rayengine::stability
