// A kernel that is made for what a scene needs finds, bit by bit, what the one for all of that type finds.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "engine/measure/rays.h"
#include "gpu/grid/grid_tracer.h"
#include "gpu/objects/objects_tracer.h"
#include "gpu/stream/stream_tracer.h"

namespace rayengine {
namespace {

/// Balls, the first of which hides one more thing: a small ball too, or what makes the scene need more.
std::shared_ptr<const Geometry> balls(const QuadricShape& hidden, const glm::dvec3& scale) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> at(-5, 5), size(0.1, 0.9);
  GeometryBuilder builder;
  builder.add(QuadricShape{}, 0, Affine::scale(glm::dvec3(0.5)));
  for (int i = 0; i < 100; ++i) {
    const glm::dvec3 center(at(random), at(random), at(random));
    builder.add(QuadricShape{}, 0, Affine::translate(center) * Affine::scale(glm::dvec3(size(random))));
  }
  builder.add(hidden, 0, Affine::scale(scale));
  return builder.build();
}

using MakeOne = std::unique_ptr<Tracer> (*)(std::shared_ptr<const Geometry>);

std::vector<Hit> hits_of(MakeOne make, const std::shared_ptr<const Geometry>& geometry) {
  const auto rays = random_rays({glm::dvec3(-6), glm::dvec3(6)}, 4000);
  std::vector<Hit> hits(rays.size());
  make(geometry)->closest(rays, hits, RayClass::bounce);
  return hits;
}

void expect_same(MakeOne make) {
  const auto special = hits_of(make, balls({}, glm::dvec3(0.01)));
  const auto turned = hits_of(make, balls({}, {0.01, 0.01, 0.02}));
  const auto clipped = hits_of(make, balls({QuadricType::sphere, false, {{-1, 0.5}}, {}, {}}, glm::dvec3(0.01)));
  EXPECT_GT(std::ranges::count_if(special, [](const Hit& h) { return h.hit(); }), 500);
  for (std::size_t i = 0; i < special.size(); ++i) {
    EXPECT_EQ(special[i].object, turned[i].object) << i;
    EXPECT_EQ(special[i].t, turned[i].t) << i;
    EXPECT_EQ(special[i].object, clipped[i].object) << i;
    EXPECT_EQ(special[i].t, clipped[i].t) << i;
  }
}

TEST(KernelVariants, OfBallsInAStream) {
  expect_same(+[](std::shared_ptr<const Geometry> g) { return make_stream_tracer(std::move(g), Precision::fast); });
}

TEST(KernelVariants, OfBallsInAGrid) {
  expect_same(+[](std::shared_ptr<const Geometry> g) { return make_grid_tracer(std::move(g), Precision::fast); });
}

TEST(KernelVariants, OfBallsOneByOne) {
  expect_same(+[](std::shared_ptr<const Geometry> g) { return make_objects_tracer(std::move(g), Precision::fast); });
}

}  // namespace
}  // namespace rayengine
