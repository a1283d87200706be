// Wood, McCane and King's experiment: all methods show the same picture, so that their times compare.

#include "engine/measure/wood.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace rayengine {
namespace {

TEST(Wood, MethodsShowTheSameSphereflake) {
  const WoodFigures figures = wood({.level = 2, .size = {96, 96}, .runs = 1});
  EXPECT_EQ(figures.primitives, 91u);
  ASSERT_EQ(figures.rows.size(), 3u);
  for (const WoodRow& row : figures.rows) {
    EXPECT_GT(row.frames_per_s, 0) << row.method;
    EXPECT_LT(row.differing, row.method == "gpu" ? .02 : .001) << row.method;
    const auto [low, high] = std::ranges::minmax(row.picture.pixels);
    EXPECT_GT(high - low, .5f) << row.method << " shows nothing";
  }
}

TEST(Wood, ShowsSixQuadrics) {
  const WoodFigures figures = wood({.level = 0, .size = {8, 8}, .runs = 1});
  ASSERT_EQ(figures.quadrics.size(), 6u);
  for (const WoodQuadric& q : figures.quadrics) {
    const auto [low, high] = std::ranges::minmax(q.picture.pixels);
    EXPECT_GT(high - low, .5f) << to_string(q.type);
  }
}

}  // namespace
}  // namespace rayengine
