// Cones: rows 6, 7, 8 and 32.

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

Ray nearly_along_generator(Random& random, double delta) {
  const double angle = random.between(0, 2 * pi);
  const glm::dvec3 from{random.between(-3, 3), random.between(-3, 3), random.between(-1, 1)};
  return {from, 0, {std::cos(angle), std::sin(angle), 1 + delta}, infinity};
}

Ray to_apex(Random& random, bool unit) {
  const glm::dvec3 from{random.between(-10, 10), random.between(-10, 10), random.between(-10, 10)};
  return {from, 0, unit ? -glm::normalize(from) : -from, infinity};
}

}  // namespace

Cases generator_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  for (const double delta : {0., 1e-8, -1e-8, 6e-8, 1.2e-7, -1.2e-7, 1e-6, -1e-6, 1e-5, -1e-5, 1e-3}) {
    Case c{.variant = number("delta = ", delta), .geometry = alone(clipped(QuadricType::cone, -100, 100))};
    c.rays = make_rays(rays, seed, [=](Random& random, std::size_t) { return nearly_along_generator(random, delta); });
    c.known = {{c.rays.size(), 1.01125, 2e-3}};
    c.rays.push_back({{.3, -3, 1}, 0, {0, 1, 1 + delta}, infinity});
    cases.push_back(c);
  }
  return cases;
}

Cases apex_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  for (const bool unit : {false, true}) {
    Case c{.variant = unit ? "direction normalised" : "direction to the apex",
           .geometry = alone(clipped(QuadricType::cone, -1, 1))};
    c.rays = make_rays(rays, seed, [=](Random& random, std::size_t) { return to_apex(random, unit); });
    for (std::size_t i = 0; !unit && i < rays; ++i) c.known.push_back({i, infinity});  // both roots are one
    cases.push_back(c);
  }
  return cases;
}

/// From below, so that the part of the surface that is clipped away is passed first.
Cases nappe_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  const std::pair<const char*, QuadricShape> shapes[]{
      {"cone", clipped(QuadricType::cone, 0, 1)},
      {"cone, capped", clipped(QuadricType::cone, 0, 1, true)},
      {"frustum, capped", clipped(QuadricType::cone, .5, 1, true)},
      {"hyperboloid2", clipped(QuadricType::hyperboloid2, 1, 2)},
      {"hyperboloid2, capped", clipped(QuadricType::hyperboloid2, 1, 2, true)},
      {"hyperboloid1, capped", clipped(QuadricType::hyperboloid1, .5, 1, true)},
      {"sphere", clipped(QuadricType::sphere, .25, 1)},
  };
  for (const auto& [name, shape] : shapes) {
    Case c{.variant = name, .geometry = alone(shape)};
    c.rays = make_rays(rays, seed, [](Random& random, std::size_t) {
      const glm::dvec3 from{random.between(-3, 3), random.between(-3, 3), random.between(-3, -1)};
      return through(from, {random.between(-1, 1), random.between(-1, 1), random.between(0, 2)});
    });
    cases.push_back(c);
  }
  return cases;
}

Cases tiny_end_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  for (const double end : {1e-3, 1e-6, 1e-9, 1e-12}) {
    Case c{.variant = number("frustum, end = ", end), .geometry = alone(clipped(QuadricType::cone, end, 1, true))};
    // At the small cap and just beside it.
    c.rays = make_rays(rays, seed, [=](Random& random, std::size_t) {
      const double angle = random.between(0, 2 * pi), r = random.between(0, 2) * end;
      const glm::dvec3 to{r * std::cos(angle), r * std::sin(angle), end * random.between(.5, 2)};
      return through(to + random.between(.5, 3) * random.direction(), to);
    });
    cases.push_back(c);
  }
  return cases;
}

}  // namespace rayengine::stability
