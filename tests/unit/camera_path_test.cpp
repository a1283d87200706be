#include "engine/scene/camera_path.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace rayengine {
namespace {

CameraKey key(double time, const glm::dvec3& from, double fov = 45) {
  return {time, {.from = from, .at = {0, 0, 1}, .up = {0, 0, 1}, .fov = fov, .size = {64, 32}}};
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double distance) {
  EXPECT_LE(glm::length(a - b), distance) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(CameraPath, GoesThroughItsKeysAtTheirTimes) {
  const CameraKey keys[] = {key(0, {0, -6, 2}), key(1, {5, -4, 3}, 30), key(4, {6, 2, 1}, 60)};
  const std::vector<Camera> cameras = camera_path(keys, 9);
  ASSERT_EQ(cameras.size(), 9u);
  for (const auto& [frame, k] : {std::pair{0, 0}, {2, 1}, {8, 2}}) {
    expect_near(cameras[static_cast<std::size_t>(frame)].from, keys[k].camera.from, 1e-14);
    EXPECT_NEAR(cameras[static_cast<std::size_t>(frame)].fov, keys[k].camera.fov, 1e-13);
  }
  for (const Camera& camera : cameras) {
    expect_near(camera.at, {0, 0, 1}, 1e-15);
    EXPECT_EQ(camera.size, glm::ivec2(64, 32));
  }
}

TEST(CameraPath, TwoKeysAreAStraightLine) {
  const CameraKey keys[] = {key(0, {0, -6, 2}), key(1, {3, -3, 2})};
  const std::vector<Camera> cameras = camera_path(keys, 4);
  for (int i = 0; i < 4; ++i) expect_near(cameras[static_cast<std::size_t>(i)].from, {i, -6 + i, 2}, 1e-14);
}

/// The middle one of three equal steps apart by an even motion, whatever the times of the keys are.
TEST(CameraPath, EvenMotionStaysEven) {
  std::vector<CameraKey> keys;
  for (const double time : {0.0, 1.0, 1.5, 4.0, 5.0}) keys.push_back(key(time, {time, 2 * time, 1}));
  const std::vector<Camera> cameras = camera_path(keys, 51);
  for (int i = 0; i < 51; ++i) expect_near(cameras[static_cast<std::size_t>(i)].from, {0.1 * i, 0.2 * i, 1}, 1e-13);
}

/// Largest change of velocity from one step to the next, over the largest velocity.
double roughness(const std::vector<Camera>& cameras, bool loop) {
  const std::size_t n = cameras.size();
  double change = 0, fastest = 0;
  for (std::size_t i = 0; i + (loop ? 0 : 2) < n; ++i) {
    const glm::dvec3 a = cameras[i].from, b = cameras[(i + 1) % n].from, c = cameras[(i + 2) % n].from;
    change = std::max(change, glm::length(c - 2. * b + a));
    fastest = std::max(fastest, glm::length(b - a));
  }
  return change / fastest;
}

TEST(CameraPath, DoesNotJerkAtKeys) {
  const CameraKey keys[] = {key(0, {0, -6, 2}), key(1, {5, -4, 3}), key(2, {6, 2, 1}), key(2.5, {1, 3, 1})};
  EXPECT_LT(roughness(camera_path(keys, 1000), false), 0.02);  // 1 where straight lines meet at an angle
}

TEST(CameraPath, OneThatEndsAsItBeganIsALoop) {
  const CameraKey keys[] = {key(0, {6, 0, 2}), key(1, {0, 6, 2}), key(2, {-6, 0, 2}), key(3, {0, -6, 2}),
                            key(4, {6, 0, 2})};
  const std::vector<Camera> cameras = camera_path(keys, 1000);
  EXPECT_NE(cameras.front().from, cameras.back().from);
  EXPECT_LT(roughness(cameras, true), 0.02);
  for (const Camera& camera : cameras) EXPECT_NEAR(glm::length(camera.from - glm::dvec3(0, 0, 2)), 6, 0.75);
  expect_near(cameras[250].from, {0, 6, 2}, 1e-13);
}

TEST(CameraPath, OnePictureIsThatOfTheFirstKey) {
  const CameraKey keys[] = {key(0, {0, -6, 2}), key(1, {5, -4, 3})};
  const std::vector<Camera> cameras = camera_path(keys, 1);
  ASSERT_EQ(cameras.size(), 1u);
  EXPECT_EQ(cameras[0].from, keys[0].camera.from);
}

}  // namespace
}  // namespace rayengine
