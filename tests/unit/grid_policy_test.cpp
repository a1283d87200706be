#include "gpu/grid/grid_policy.h"

#include <gtest/gtest.h>

namespace rayengine {
namespace {

using enum GridState;

std::optional<GridState> by_share(double share, const GridCounts& waiting) {
  return next_kernel({.rule = GridPolicy::Rule::share, .share = share}, waiting);
}

TEST(GridPolicy, EndsWhenNoRayWaits) {
  EXPECT_EQ(by_share(0, {0, 0, 0}), std::nullopt);
  EXPECT_EQ(next_kernel({.rule = GridPolicy::Rule::most}, {0, 0, 0}), std::nullopt);
}

TEST(GridPolicy, TraversesUntilTheShareWaits) {
  EXPECT_EQ(by_share(0.5, {60, 40, 0}), traverse);
  EXPECT_EQ(by_share(0.5, {50, 50, 0}), intersect);
  EXPECT_EQ(by_share(0, {99, 1, 0}), intersect);
  EXPECT_EQ(by_share(0, {99, 0, 0}), traverse);
  EXPECT_EQ(by_share(1, {1, 99, 0}), traverse);
  EXPECT_EQ(by_share(1, {0, 99, 0}), intersect);
}

TEST(GridPolicy, AlwaysFindsWorkThatIsThere) {
  EXPECT_EQ(by_share(1, {0, 5, 9}), shade);  // neither is all
  EXPECT_EQ(by_share(1, {0, 9, 5}), intersect);
  EXPECT_EQ(by_share(0.5, {1, 0, 9}), shade);
}

TEST(GridPolicy, RunsWhatMostWaitFor) {
  const GridPolicy most{.rule = GridPolicy::Rule::most};
  EXPECT_EQ(next_kernel(most, {5, 4, 3}), traverse);
  EXPECT_EQ(next_kernel(most, {5, 6, 3}), intersect);
  EXPECT_EQ(next_kernel(most, {5, 6, 7}), shade);
}

}  // namespace
}  // namespace rayengine
