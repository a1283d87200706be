// Row 2: rays an ulp or some beside a tangent. Origins and directions are small whole numbers but for the one
// coordinate that tells the side, so nothing of a ray is rounded and the answer is known.

#include <cmath>

#include "engine/measure/stress/aim.h"
#include "engine/measure/stress/families.h"
#include "engine/measure/stress/shapes.h"

namespace rayengine::stability {
namespace {

struct Touch {
  const char* name;
  QuadricShape shape;
  glm::dvec3 point;
  int axis;                            ///< of the point's coordinate that is changed
  int inside;                          ///< sign of the change towards the inside, which is hit
  std::vector<glm::dvec3> directions;  ///< tangents at the point, with no part along the axis
};

const std::vector<Touch>& touches() {
  using enum QuadricType;

  static const std::vector<Touch> all{
      {"sphere", {.type = sphere}, {0, 1, 0}, 1, -1, {{1, 0, 0}, {0, 0, 1}, {3, 0, 4}, {-5, 0, 12}}},
      {"cylinder", {.type = cylinder}, {0, 1, .5}, 1, -1, {{1, 0, 0}, {-1, 0, 0}, {8192, 0, 1}}},
      {"cone", {.type = cone}, {0, .5, .5}, 1, -1, {{1, 0, 0}, {-3, 0, 0}}},
      {"paraboloid", {.type = paraboloid}, {0, .5, .25}, 1, -1, {{1, 0, 0}, {-3, 0, 0}}},
      {"hyperboloid1", {.type = hyperboloid1}, {0, 1, 0}, 1, -1, {{1, 0, 0}, {2, 0, 1}, {-3, 0, 1}}},
      {"hyperboloid2", {.type = hyperboloid2}, {0, 0, 1}, 2, 1, {{1, 0, 0}, {3, 4, 0}, {0, -1, 0}}},
      {"saddle", {.type = saddle}, {0, .5, -.25}, 2, 1, {{1, 0, 0}, {-3, 0, 0}}},
      {"general", of_form({1, 0, 0, 0, 1, 0, 0, 1, 0, -25}), {0, 0, 5}, 2, -1, {{1, 0, 0}, {3, 4, 0}, {-5, 12, 0}}},
  };
  return all;
}

constexpr int farthest = 64;  // ulps

/// `units` ulps of a format with this unit round-off away from zero.
double beside(double x, int units, double roundoff) { return x * (1 + units * (units > 0 ? 2 * roundoff : roundoff)); }

Case beside_tangent(const Touch& touch, const std::string& format, double roundoff, std::size_t rays,
                    std::uint64_t seed) {
  Case c{.variant = std::string(touch.name) + ", ulps of " + format, .geometry = alone(touch.shape)};
  for (std::size_t i = 0; i < rays; ++i) {
    Random random(seed, i);
    const int units = static_cast<int>(i % (2 * farthest + 1)) - farthest;
    const double length = i % 3 == 0 ? 4 : i % 3 == 1 ? 1000 : std::round(random.between(4, 1000));
    const glm::dvec3 direction = touch.directions[random.below(touch.directions.size())];
    Ray ray{touch.point - length * direction, 0, direction, infinity};
    ray.origin[touch.axis] = beside(touch.point[touch.axis], units, roundoff);
    // Away from zero is inside for some and outside for others.
    const bool away_is_inside = touch.inside * touch.point[touch.axis] > 0;
    if (units == 0 || (units > 0) != away_is_inside) c.known.push_back({i, infinity});
    c.rays.push_back(ray);
  }
  return c;
}

}  // namespace

Cases tangent_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  for (const Touch& touch : touches()) {
    cases.push_back(beside_tangent(touch, "float", 0x1p-24, rays, seed));
    cases.push_back(beside_tangent(touch, "double", 0x1p-53, rays, seed));
  }
  return cases;
}

}  // namespace rayengine::stability
