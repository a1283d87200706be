#include "gpu/points/points_tracer.h"

#include <gtest/gtest.h>

#include "engine/measure/rays.h"

namespace rayengine {
namespace {

std::shared_ptr<const Geometry> spheres_and_a_plane() {
  GeometryBuilder builder;
  for (int i = 0; i < 20; ++i)
    builder.add(QuadricShape{}, 0, Affine::translate({2.5 * (i % 5), 2.5 * (i / 5), 0.1 * i}));
  builder.add(QuadricShape{QuadricType::plane, false, {}, {}, {}}, 0, Affine::translate({0, 0, -2}));
  return builder.build();
}

TEST(PointsTracer, AnswersDoNotDependOnBatches) {
  const auto geometry = spheres_and_a_plane();
  const auto rays = random_rays(Box{{-1, -1, -3}, {12, 10, 4}}, 1000);
  std::vector<Hit> at_once(rays.size()), by_seven(rays.size());
  make_points_tracer(geometry, Precision::robust)->closest(rays, at_once, RayClass::primary);
  const auto small = make_points_tracer(geometry, Precision::robust, {.batch = 7});
  EXPECT_EQ(small->limits().batch, 7u);
  small->closest(rays, by_seven, RayClass::primary);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(by_seven[i].t, at_once[i].t);
    EXPECT_EQ(by_seven[i].object, at_once[i].object);
    hits += at_once[i].hit();
  }
  EXPECT_GT(hits, rays.size() / 4);
}

TEST(PointsTracer, NothingIsAskedAndNothingIsThere) {
  const auto tracer = make_points_tracer(GeometryBuilder().build(), Precision::fast);
  tracer->closest({}, {}, RayClass::primary);
  std::vector<std::uint32_t> status(2, 99);
  tracer->any(std::vector<Ray>(2), status, RayClass::shadow);
  EXPECT_EQ(status, (std::vector<std::uint32_t>{status_miss, status_miss}));
}

}  // namespace
}  // namespace rayengine
