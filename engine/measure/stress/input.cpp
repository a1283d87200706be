// Rays at the edge of what a ray may be: rows 25 and 26.

#include <cmath>
#include <limits>

#include "engine/measure/stress/aim.h"
#include "engine/measure/stress/families.h"
#include "engine/measure/stress/shapes.h"

namespace rayengine::stability {
namespace {

using enum QuadricType;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double& component(Ray& ray, std::size_t i) {
  const int axis = static_cast<int>(i % 4);
  if (axis == 3) return i < 4 ? ray.tmin : ray.tmax;
  return i < 4 ? ray.origin[axis] : ray.direction[axis];
}

Ray plain(Random& random) {
  const glm::dvec3 to{random.between(-3, 3), random.between(-3, 3), random.between(0, 3)};
  return through(to + 9. * random.direction(), to);
}

/// A plain ray with one to three of its eight numbers replaced, until it is as valid as wanted.
Ray spoilt(Random& random, bool valid) {
  constexpr double valid_values[]{0., -0., 1e30, -1e30, 5e-324, 1e-310, -1e-40, 1e300, 1e-200, -1e-200};
  constexpr double bad_values[]{nan, infinity, -infinity, 0, 1e30};
  for (;;) {
    Ray ray = plain(random);
    for (std::size_t k = 1 + random.below(3); k > 0; --k)
      component(ray, random.below(8)) = valid ? valid_values[random.below(10)] : bad_values[random.below(5)];
    if (!valid && random.below(6) == 0) ray.direction = glm::dvec3(0);
    if (!valid && random.below(6) == 0) ray.tmin = 2, ray.tmax = 1;
    if (is_valid(ray) == valid) return ray;
  }
}

/// A ray that hits exactly at t, where nothing is rounded.
struct End {
  QuadricShape shape;
  Ray ray;
  double t;
};

std::vector<End> quadric_ends() {
  const auto ray = [](glm::dvec3 from, glm::dvec3 direction) { return Ray{from, 0, direction, infinity}; };
  return {
      {{.type = sphere}, ray({-3, 0, 0}, {1, 0, 0}), 2},
      {{.type = cylinder}, ray({-3, 0, .5}, {1, 0, 0}), 2},
      {{.type = cylinder, .capped = true}, ray({.25, .5, 3}, {0, 0, -1}), 2},
      {{.type = cone}, ray({-3, 0, .5}, {1, 0, 0}), 2.5},
      {{.type = paraboloid}, ray({-3, 0, .25}, {1, 0, 0}), 2.5},
      {{.type = hyperboloid1}, ray({-3, 0, 0}, {2, 0, 0}), 1},
      {{.type = hyperboloid2}, ray({0, 0, -1.5}, {0, 0, 1}), .5},
      {{.type = saddle}, ray({.5, 0, 2}, {0, 0, -1}), 1.75},
      {{.type = plane}, ray({.25, .25, 2}, {0, 0, -4}), .5},
      {{.type = disk}, ray({.25, .25, 2}, {0, 0, -1}), 2},
      {of_form({1, 0, 0, 0, 1, 0, 0, 1, 0, -25}), ray({-8, 3, 0}, {1, 0, 0}), 4},
  };
}

/// tmin or tmax at t and up to two steps beside, of the format's ulp below 16: the ends are numbers of the format.
std::vector<Ray> ends_of(const Ray& ray, double t, double roundoff, std::size_t rays, std::uint64_t seed) {
  return make_rays(rays, seed, [=](Random& random, std::size_t i) {
    Ray cut = ray;
    const double step = 16 * roundoff, back = std::round(random.between(0, 8));
    cut.origin -= back * ray.direction;
    (random.below(2) ? cut.tmin : cut.tmax) = t + back + (static_cast<double>(i % 5) - 2) * step;
    return cut;
  });
}

}  // namespace

Cases bad_input_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  for (const bool valid : {false, true}) {
    Case c{.variant = valid ? "extreme but valid" : "invalid", .geometry = mixture()};
    c.invalid = !valid;
    c.rays = make_rays(rays, seed, [=](Random& random, std::size_t) { return spoilt(random, valid); });
    cases.push_back(c);
  }
  return cases;
}

Cases interval_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  const auto add = [&](const std::string& name, const std::shared_ptr<const Geometry>& geometry, const Ray& ray,
                       double t) {
    for (const auto& [format, roundoff] : {std::pair{"float", 0x1p-24}, std::pair{"double", 0x1p-53}})
      cases.push_back({.variant = name + ", ulps of " + format,
                       .geometry = geometry,
                       .rays = ends_of(ray, t, roundoff, rays, seed)});
  };
  for (const End& end : quadric_ends()) {
    const std::string name = std::string(to_string(end.shape.type)) + (end.shape.capped ? ", its cap" : "");
    add(name, alone(end.shape), end.ray, end.t);
  }
  add("triangle", alone(corner_triangle(4)), {{1, 1, 2}, 0, {0, 0, -1}, infinity}, 2);
  return cases;
}

}  // namespace rayengine::stability
