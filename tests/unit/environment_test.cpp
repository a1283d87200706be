#include "engine/render/environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "accel/tracer.h"

namespace rayengine {
namespace {

constexpr int width = 8, height = 4;

/// Red counts columns, green rows; a stray first channel must not be taken for a colour.
Background numbered() {
  auto image = std::make_shared<Image>(width, height, std::vector<std::string>{"A", "B", "G", "R"});
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float* p = image->pixel(x, y);
      p[0] = 99, p[1] = 7, p[2] = static_cast<float>(y), p[3] = static_cast<float>(x);
    }
  return {glm::vec3(0), image};
}

/// The direction of image coordinates (x, y), in pixels.
glm::dvec3 direction(double x, double y) {
  const double longitude = std::numbers::pi - 2 * std::numbers::pi * x / width;
  const double polar = std::numbers::pi * y / height;
  return {std::sin(polar) * std::cos(longitude), std::sin(polar) * std::sin(longitude), std::cos(polar)};
}

void expect_color(const glm::vec3& color, float r, float g, float b) {
  EXPECT_NEAR(color.r, r, 1e-5);
  EXPECT_NEAR(color.g, g, 1e-5);
  EXPECT_NEAR(color.b, b, 1e-5);
}

TEST(Environment, PixelCentresGiveTheirPixels) {
  const Environment environment(numbered());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      expect_color(environment(3.0 * direction(x + 0.5, y + 0.5)), static_cast<float>(x), static_cast<float>(y), 7);
}

TEST(Environment, AxesLieWhereTheyArePromised) {
  const Environment environment(numbered());
  expect_color(environment({1, 0, 0}), 3.5f, 1.5f, 7);  // the middle of the image
  expect_color(environment({0, 1, 0}), 1.5f, 1.5f, 7);  // to the left of a viewer who looks along x
  expect_color(environment({0, -1, 0}), 5.5f, 1.5f, 7);
  expect_color(environment({-1, 0, 0}), 3.5f, 1.5f, 7);  // the seam: between the last column and the first
  EXPECT_NEAR(environment({0, 0, 1}).g, 0, 1e-6);        // the top row
  EXPECT_NEAR(environment({0, 0, -1}).g, 3, 1e-6);
}

TEST(Environment, ColumnsMeetBehindTheViewer) {
  const Environment environment(numbered());
  expect_color(environment(direction(0.25, 1.5)), 0.75f * 0 + 0.25f * 7, 1, 7);
  expect_color(environment(direction(7.75, 1.5)), 0.75f * 7 + 0.25f * 0, 1, 7);
}

TEST(Environment, WithoutAnImageItIsOneColour) {
  expect_color(Environment({glm::vec3(0.1f, 0.2f, 0.3f), nullptr})({1, 2, 3}), 0.1f, 0.2f, 0.3f);
}

TEST(Environment, RefusesAnEmptyImage) { EXPECT_THROW(Environment({glm::vec3(0), std::make_shared<Image>()}), Error); }

}  // namespace
}  // namespace rayengine
