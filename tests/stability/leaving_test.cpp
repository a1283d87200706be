// What a renderer relies on: no convex body shadows itself, at any scale, place and stretch of the stability suite.

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "cpu/reference_tracer.h"
#include "engine/measure/rays.h"
#include "engine/measure/stress/aim.h"
#include "engine/measure/stress/shapes.h"
#include "engine/tracers.h"

namespace rayengine {
namespace {

struct Place {
  const char* name;
  Affine map;
};

std::vector<Place> places() {
  const auto scaled = [](double by) { return Affine::scale(glm::dvec3(by)); };
  return {{"as it is", {}},
          {"times 1e-15", scaled(1e-15)},
          {"times 1e-6", scaled(1e-6)},
          {"a planet", scaled(6371000)},
          {"times 1e15", scaled(1e15)},
          {"stretched", stability::turned(2) * Affine::scale({1, 1e-3, 1e3})},
          {"a million away", Affine::translate({4.5e6, 6e6, 0}) * stability::turned(3)}};
}

bool is_convex(const stability::Body& body) {
  using enum QuadricType;
  const QuadricType type = body.shape.type;
  return type == sphere || type == disk ||
         (body.shape.capped && (type == cylinder || type == cone || type == paraboloid));
}

/// How many rays that leave the body outward, as a renderer starts them, meet it again.
std::size_t shadowed(const std::string& tracer, const stability::Body& body, const Affine& map) {
  const auto geometry = stability::alone(body.shape, map);
  // Chosen where the body is round; all come from outside, since chords would also leave the insides of open bodies.
  std::vector<Ray> from_outside = stability::at_disc(body.center, body.radius, 4 * body.radius, 400, 1);
  for (Ray& ray : from_outside) ray = stability::through(map.point(ray.origin), map.point(ray.at(4 * body.radius)));
  std::vector<Hit> hits(from_outside.size());
  make_reference_tracer(geometry)->closest(from_outside, hits, RayClass::primary);
  const std::vector<Ray> bounces = bounce_rays(*geometry, from_outside, hits);
  EXPECT_GT(bounces.size(), 50u);
  std::vector<std::uint32_t> status(bounces.size());
  make_tracer(tracer, geometry)->any(bounces, status, RayClass::shadow);
  return static_cast<std::size_t>(std::ranges::count(status, status_hit));
}

class Leaving : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Tracers, Leaving, testing::Values("embree", "bvh", "stream"));

TEST_P(Leaving, NoConvexBodyShadowsItself) {
  for (const stability::Body& body : stability::bodies())
    for (const Place& place : places()) {
      SCOPED_TRACE(body.name + ", " + place.name);
      EXPECT_TRUE(!is_convex(body) || shadowed(GetParam(), body, place.map) == 0);
    }
}

}  // namespace
}  // namespace rayengine
