#include "engine/render/sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace rayengine {
namespace {

/// The share of the filter's weight below x, by summing weights.
double share_below(double x) {
  const int steps = 2000;
  const double width = (x + 1.5) / steps;
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += filter_weight(-1.5 + (i + 0.5) * width) * width;
  return sum;
}

TEST(Sampling, ASingleSampleIsTheCentre) { EXPECT_EQ(PixelSampler(1).offset(17, 4, 0), glm::dvec2(0, 0)); }

TEST(Sampling, TheFilterHasUnitIntegralAndIsEven) {
  EXPECT_NEAR(share_below(1.5), 1, 1e-6);
  EXPECT_NEAR(filter_weight(0.7), filter_weight(-0.7), 1e-15);
  EXPECT_GT(filter_weight(0), filter_weight(0.2));
  EXPECT_EQ(filter_weight(1.5), 0);
  EXPECT_EQ(filter_weight(-2), 0);
}

TEST(Sampling, QuantilesAreThoseOfTheFilter) {
  for (double u : {0.001, 0.1, 0.25, 0.5, 0.61803, 0.9, 0.999})
    EXPECT_NEAR(share_below(filter_quantile(u)), u, 1e-4) << u;
}

TEST(Sampling, SixteenSamplesStratifyEveryPixelBothWays) {
  const PixelSampler sampler(16);
  for (int pixel = 0; pixel < 50; ++pixel) {
    std::set<int> columns, rows, cells;
    for (int s = 0; s < 16; ++s) {
      const glm::dvec2 offset = sampler.offset(pixel, 3 * pixel, s);
      const double u = share_below(offset.x), v = share_below(offset.y);
      columns.insert(static_cast<int>(u * 16));
      rows.insert(static_cast<int>(v * 16));
      cells.insert(static_cast<int>(u * 4) * 4 + static_cast<int>(v * 4));
    }
    EXPECT_EQ(columns.size(), 16u);
    EXPECT_EQ(rows.size(), 16u);
    EXPECT_EQ(cells.size(), 16u);
  }
}

TEST(Sampling, PixelsDifferAndRepeat) {
  const PixelSampler sampler(4);
  EXPECT_NE(sampler.offset(1, 0, 2), sampler.offset(0, 1, 2));
  EXPECT_EQ(sampler.offset(5, 9, 3), PixelSampler(4).offset(5, 9, 3));
}

}  // namespace
}  // namespace rayengine
