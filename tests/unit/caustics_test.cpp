// Light focused by a ball of glass, against what Snell's law says of it in closed form.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "accel/tracer.h"
#include "engine/render/photons.h"
#include "engine/render/render.h"
#include "engine/tracers.h"

namespace rayengine {
namespace {

constexpr double index_of_glass = 1.5, floor_below = 1.8, passed = 0.81;  // twice through the surface at 0.9

/// A ball of glass at the origin over a diffuse floor, in white light along `direction` or from `position`.
Scene ball_over_floor(const Light& light) {
  GeometryBuilder builder;
  builder.add(QuadricShape{}, 1);
  builder.add(QuadricShape{QuadricType::plane}, 0, Affine::translate({0, 0, -floor_below}));
  Scene scene;
  scene.geometry = builder.build();
  scene.lights = {light};
  scene.materials = {{.color = {1, 1, 1}, .diffuse = 1},
                     {.color = {1, 1, 1}, .diffuse = 0, .transmit = .9f, .ior = static_cast<float>(index_of_glass)}};
  return scene;
}

Light sun(const glm::dvec3& direction) { return {Light::Type::directional, {}, direction, {1, 1, 1}}; }

/// Where a vertical ray that meets the ball `b` beside its middle reaches the floor: entering at the angle i = asin(b),
/// it turns by i - r at each surface, and leaves pi - 2 r farther round.
double landing(double b) {
  const double i = std::asin(b), r = std::asin(b / index_of_glass), round = i + std::numbers::pi - 2 * r;
  return std::sin(round) - (floor_below + std::cos(round)) * std::tan(2 * (i - r));
}

/// The light that lands within `radius` of the middle, over the disc's area.
double mean_irradiance(double radius) {
  constexpr int steps = 100000;
  double power = 0;
  for (int k = 0; k < steps; ++k) {
    const double b = (k + 0.5) / steps;
    if (std::abs(landing(b)) < radius) power += 2 * std::numbers::pi * b / steps;
  }
  return passed * power / (std::numbers::pi * radius * radius);
}

/// The same as photons have it: the mean of many estimates.
glm::dvec3 mean_of_map(const PhotonMap& map, const glm::dvec3& middle, double radius) {
  constexpr int side = 60;
  glm::dvec3 sum(0);
  int count = 0;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const glm::dvec3 offset(radius * (2 * (x + .5) / side - 1), radius * (2 * (y + .5) / side - 1), 0);
      if (glm::length(offset) > radius) continue;
      sum += glm::dvec3(map.irradiance(middle + offset, {0, 0, 1}));
      ++count;
    }
  return sum / static_cast<double>(count);
}

class CausticsOf : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Tracers, CausticsOf, testing::Values("embree", "bvh", "cones"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(CausticsOf, ABallAreAsBrightAsSnellSays) {
  const Scene scene = ball_over_floor(sun({0, 0, -1}));
  const auto tracer = make_tracer(GetParam(), scene.geometry);
  const Caustics caustics = trace_caustics(scene, *tracer, 400000, 5);
  EXPECT_GT(caustics.rays, 2.9 * 400000);  // all meet the ball: in, out, and down
  for (const double radius : {.1, .2, .35, .5}) {
    const glm::dvec3 mean = mean_of_map(caustics.map, {0, 0, -floor_below}, radius);
    EXPECT_NEAR(mean.x / mean_irradiance(radius), 1, .04) << radius;
    EXPECT_EQ(mean.x, mean.y);
  }
  // Nothing comes to the floor's other side.
  EXPECT_EQ(caustics.map.irradiance({0, 0, -floor_below}, {0, 0, -1}), glm::vec3(0));
}

TEST(Caustics, LieWhereTheMiddleRayPointsTo) {
  const Scene scene = ball_over_floor(sun({.5, .25, -1}));
  const auto tracer = make_tracer("bvh", scene.geometry);
  const Caustics caustics = trace_caustics(scene, *tracer, 200000, 5);
  glm::dvec3 sum(0);
  double weight = 0;
  for (double y = -2; y < 3; y += .05)
    for (double x = -2; x < 3; x += .05) {
      const double light = caustics.map.irradiance({x, y, -floor_below}, {0, 0, 1}).x;
      sum += light * light * glm::dvec3(x, y, 0);
      weight += light * light;
    }
  EXPECT_LT(glm::distance(sum / weight, floor_below * glm::dvec3(.5, .25, 0)), .1);
}

/// Without bending the photons are the light: of a lamp, too, which does not fall off with distance.
TEST(Caustics, ThroughWhatDoesNotBendAreTheLight) {
  for (const Light& light : {sun({0, 0, -1}), Light{Light::Type::point, {.3, 0, 3}, {}, {1, 1, 1}}}) {
    Scene scene = ball_over_floor(light);
    scene.materials[1].ior = 1;
    const auto tracer = make_tracer("bvh", scene.geometry);
    const Caustics caustics = trace_caustics(scene, *tracer, 400000, 5);
    for (const glm::dvec3& p : {glm::dvec3(0, 0, -floor_below), glm::dvec3(.4, .2, -floor_below)}) {
      const glm::dvec3 to_light = light.type == Light::Type::point ? light.position - p : -light.direction;
      EXPECT_NEAR(caustics.map.irradiance(p, {0, 0, 1}).x, passed * glm::normalize(to_light).z, .05);
    }
  }
}

TEST(Caustics, ShowInThePictureOnlyWhenAskedFor) {
  Scene scene = ball_over_floor(sun({0, 0, -1}));
  scene.camera = {.from = {0, -2.5, -1.2}, .at = {0, 0, -floor_below}, .fov = 30, .size = {32, 32}};
  const auto tracer = make_tracer("bvh", scene.geometry);
  const float dark = *render(scene, *tracer).image.pixel(16, 16);
  const RenderResult lit = render(scene, *tracer, {.caustics = 100000, .threads = 1});
  EXPECT_EQ(dark, 0);  // the ball's shadow
  EXPECT_GT(*lit.image.pixel(16, 16), 4);
  EXPECT_GT(lit.stats.photon_rays, 100000u);
}

TEST(RenderInvariance, CausticsOfAnyNumberOfThreadsAreTheSame) {
  Scene scene = ball_over_floor(sun({0, 0, -1}));
  scene.camera = {.from = {0, -2.5, -1.2}, .at = {0, 0, -floor_below}, .fov = 30, .size = {32, 32}};
  const auto tracer = make_tracer("bvh", scene.geometry);
  EXPECT_EQ(render(scene, *tracer, {.caustics = 100000, .threads = 1}).image.pixels,
            render(scene, *tracer, {.caustics = 100000, .threads = 3}).image.pixels);
}

TEST(Caustics, OfScenesWithoutGlassOrLightAreNone) {
  Scene scene = ball_over_floor(sun({0, 0, -1}));
  const auto tracer = make_tracer("bvh", scene.geometry);
  Scene dark = scene, dull = scene;
  dark.lights.clear();
  dull.materials[1].transmit = 0;
  EXPECT_EQ(trace_caustics(dark, *tracer, 1000, 5).map.size(), 0u);
  EXPECT_EQ(trace_caustics(dull, *tracer, 1000, 5).map.size(), 0u);
  EXPECT_THROW(render(scene, *tracer, {.shading = Shading::direct, .caustics = 10}), Error);
  EXPECT_THROW(render(scene, *tracer, {.caustics = 1 << 27}), Error);
}

}  // namespace
}  // namespace rayengine
