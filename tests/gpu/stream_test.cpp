#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cpu/reference_tracer.h"
#include "gpu/stream_tracer.h"

namespace rayengine {
namespace {

std::shared_ptr<const Geometry> spheres_and_triangles() {
  GeometryBuilder builder;
  builder.add(QuadricShape{}, 0, Affine::translate({-2, 0, 0}));
  builder.add(Mesh{{{1, -1, 0}, {3, -1, 0}, {1, 1, 0}, {3, 1, 0}}, {}, {{0, 1, 2}, {2, 1, 3}}});
  builder.add(QuadricShape{QuadricType::cylinder, true, {}, {}, {}}, 0, Affine::translate({0, 0, -4}));
  return builder.build();
}

Ray down(double x, double y) {
  Ray ray;
  ray.origin = {x, y, 10};
  ray.direction = {0, 0, -1};
  return ray;
}

TEST(Stream, HitsWhatIsThere) {
  const auto geometry = spheres_and_triangles();
  const auto stream = make_stream_tracer(geometry, Precision::robust);
  const std::vector<Ray> rays{down(-2, .5), down(1.5, 0), down(2.5, .75), down(.25, .25), down(9, 9)};
  std::vector<Hit> hits(rays.size());
  stream->closest(rays, hits, RayClass::primary);
  EXPECT_EQ(hits[0].object, 0u);
  EXPECT_NEAR(hits[0].t, 10 - std::sqrt(.75), 1e-14);
  EXPECT_EQ(hits[1].object, 1u);
  EXPECT_EQ(hits[1].primitive, 0u);
  EXPECT_EQ(hits[1].t, 10);
  EXPECT_EQ(hits[2].primitive, 1u);
  EXPECT_EQ(hits[3].object, 2u);
  EXPECT_EQ(hits[3].primitive, 2u);
  EXPECT_NEAR(hits[3].t, 13, 1e-14);
  EXPECT_FALSE(hits[4].hit());
}

TEST(Stream, AnswersInvalidRaysWithAMiss) {
  const auto stream = make_stream_tracer(spheres_and_triangles(), Precision::robust);
  Ray nan = down(0, 0), still = down(-2, 0);
  nan.origin.x = std::nan("");
  still.direction = {0, 0, 0};
  const std::vector<Ray> rays{nan, still, down(-2, 0)};
  std::vector<Hit> hits(3);
  std::vector<std::uint32_t> status(3);
  stream->closest(rays, hits, RayClass::primary);
  stream->any(rays, status, RayClass::shadow);
  for (const int i : {0, 1}) {
    EXPECT_EQ(hits[i].status, status_invalid);
    EXPECT_EQ(status[i], status_invalid);
  }
  EXPECT_TRUE(hits[2].hit());
  EXPECT_EQ(status[2], status_hit);
}

TEST(Stream, FindsAllHitsInOrder) {
  const auto geometry = spheres_and_triangles();
  const auto stream = make_stream_tracer(geometry, Precision::robust);
  const auto oracle = make_reference_tracer(geometry);
  const std::vector<Ray> rays{down(-2, .5), down(.25, .25), down(9, 9), down(1.5, 0)};
  const HitLists lists = stream->all(rays), right = oracle->all(rays);
  ASSERT_EQ(lists.offsets, right.offsets);
  for (std::size_t i = 0; i < lists.hits.size(); ++i) {
    EXPECT_EQ(lists.hits[i].object, right.hits[i].object);
    EXPECT_EQ(lists.hits[i].primitive, right.hits[i].primitive);
    EXPECT_NEAR(lists.hits[i].t, right.hits[i].t, 1e-13);
  }
}

TEST(Stream, AnEmptySceneIsMissed) {
  const auto stream = make_stream_tracer(GeometryBuilder().build(), Precision::robust);
  const std::vector<Ray> rays{down(0, 0)};
  std::vector<Hit> hits(1);
  stream->closest(rays, hits, RayClass::primary);
  EXPECT_FALSE(hits[0].hit());
}

}  // namespace
}  // namespace rayengine
