#include <gtest/gtest.h>

#include "engine/load/load.h"
#include "tests/load/loading.h"

namespace rayengine {
namespace {

const Camera start{.from = {1, 2, 3}, .at = {4, 5, 6}, .up = {0, 1, 0}, .fov = 30, .size = {64, 32}};

std::vector<CameraKey> load(const std::string& text) {
  const test::TemporaryFolder folder;
  return load_camera_path(folder.write("path.json", text), start);
}

std::string error(const std::string& text) {
  return test::error_of([&] { load(text); });
}

void expect_error(const std::string& text, const std::string& what) {
  const std::string message = error(text);
  EXPECT_NE(message.find("path.json:" + what), std::string::npos) << message;
}

TEST(LoadCameraPath, AKeyIsLikeTheOneBeforeWhereItSaysNothing) {
  const std::vector<CameraKey> keys =
      load(R"([{}, {"from": [0, 0, 1], "fov": 60}, {"time": 5, "at": [1, 1, 1]}, {"up": [0, 0, 1]}])");
  ASSERT_EQ(keys.size(), 4u);
  EXPECT_EQ(keys[0].camera.from, start.from);
  EXPECT_EQ(keys[1].camera.from, glm::dvec3(0, 0, 1));
  EXPECT_EQ(keys[1].camera.at, start.at);
  EXPECT_EQ(keys[3].camera.from, glm::dvec3(0, 0, 1));
  EXPECT_EQ(keys[3].camera.at, glm::dvec3(1, 1, 1));
  EXPECT_EQ(keys[3].camera.fov, 60);
  EXPECT_EQ(keys[3].camera.up, glm::dvec3(0, 0, 1));
  const double times[] = {0, 1, 5, 6};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(keys[k].time, times[k]);
    EXPECT_EQ(keys[k].camera.size, start.size);
  }
}

TEST(LoadCameraPath, WhatIsWrongIsNamedWithItsLine) {
  expect_error("[{}]", "1: a path needs at least two keys, got 1");
  expect_error("[]", "1: a path needs at least two keys, got 0");
  expect_error("{}", "1: expected a list for 'path', got an object");
  expect_error("[{},\n3]", "2: expected an object for 'path', got a number");
  expect_error("[{},\n{\"form\": [1, 2, 3]}]", "2: unknown key 'form' in 'path'; use time, from, at, up, fov");
  expect_error("[{},\n\n{\"fov\": 200}]", "3: the camera's angle is out of range");
  expect_error("[{},\n{\"from\": [4, 5, 6]}]", "2: the camera stands where it looks");
  expect_error("[{\"time\": 2},\n{\"time\": 2}]", "2: the times of a path's keys must rise");
  expect_error("[{}, {}", "1: not valid JSON");
  EXPECT_NE(test::error_of([] { load_camera_path("/nowhere/path.json", start); }).find("path.json"), std::string::npos);
}

}  // namespace
}  // namespace rayengine
