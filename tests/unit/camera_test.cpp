#include "engine/render/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "accel/tracer.h"
#include "engine/render/render.h"

namespace rayengine {
namespace {

Camera looking_along_y(int width, int height) {
  return {.from = {1, 2, 3}, .at = {1, 7, 3}, .up = {0, 0, 4}, .fov = 90, .size = {width, height}};
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-15);
}

TEST(Camera, TheMiddleLooksAtThePoint) {
  const Ray ray = camera_ray(looking_along_y(64, 64), 32, 32);
  expect_near(ray.origin, {1, 2, 3});
  expect_near(ray.direction, {0, 1, 0});
  EXPECT_EQ(ray.tmin, 0);
  EXPECT_EQ(ray.tmax, infinity);
}

TEST(Camera, RightAndUpAreThoseOfARightHandedView) {
  // Ninety degrees: the corner lies one unit to the right (+x) and one up for one ahead.
  expect_near(camera_ray(looking_along_y(64, 64), 64, 0).direction, glm::dvec3(1, 1, 1) / std::sqrt(3.0));
  expect_near(camera_ray(looking_along_y(64, 64), 0, 64).direction, glm::dvec3(-1, 1, -1) / std::sqrt(3.0));
}

TEST(Camera, TheAngleSpansTheHeightOfAWideImage) {
  expect_near(camera_ray(looking_along_y(128, 64), 128, 32).direction, glm::dvec3(2, 1, 0) / std::sqrt(5.0));
  expect_near(camera_ray(looking_along_y(128, 64), 64, 0).direction, glm::dvec3(0, 1, 1) / std::sqrt(2.0));
}

TEST(Camera, RefusesWhatSeesNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Camera good = looking_along_y(8, 8);
  EXPECT_NO_THROW(CameraFrame{good});
  for (const auto& spoil : std::initializer_list<void (*)(Camera&, double)>{
           [](Camera&c, double) { c.at = c.from; },
           [](Camera&c, double) {
             c.up = {0, -2, 0};
           },
           [](Camera&c, double) {
             c.up = {0, 0, 0};
           },
           [](Camera&c, double) { c.fov = 0; }, [](Camera&c, double) { c.fov = 180; },
           [](Camera&c, double) { c.size.y = 0; }, [](Camera&c, double n) { c.fov = n; },
           [](Camera&c, double n) { c.up.x = n; }, [](Camera&c, double n) { c.from.z = n; },
           [](Camera&c, double) { c.at.x = infinity; }}) {
    Camera bad = good;
    spoil(bad, nan);
    EXPECT_THROW(CameraFrame{bad}, Error);
  }
}

}  // namespace
}  // namespace rayengine
