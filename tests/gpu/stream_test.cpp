#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/packing.hpp>
#include <limits>
#include <random>

#include "cpu/reference_tracer.h"
#include "engine/measure/rays.h"
#include "gpu/stream/stream_batch.h"
#include "gpu/stream/stream_order.h"
#include "gpu/stream/stream_tracer.h"

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

std::shared_ptr<const Geometry> crowd() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-5, 5);
  GeometryBuilder builder;
  builder.add(QuadricShape{QuadricType::plane, false, {}, {}, {}}, 0, Affine::translate({0, 0, -6}));
  for (int i = 0; i < 400; ++i) {
    const Affine to = Affine::translate({place(random), place(random), place(random)});
    builder.add(QuadricShape{i % 2 ? QuadricType::paraboloid : QuadricType::cylinder, true, {}, {}, {}}, 0, to);
    builder.add(Mesh{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {}, {{0, 1, 2}}}, 0, to);
  }
  return builder.build();
}

std::vector<Hit> answers(const std::shared_ptr<const Geometry>& geometry, std::span<const Ray> rays,
                         const StreamOptions& options) {
  std::vector<Hit> hits(rays.size());
  make_stream_tracer(geometry, Precision::fast, options)->closest(rays, hits, RayClass::bounce);
  return hits;
}

TEST(Stream, HowRaysTravelDoesNotChangeTheirAnswers) {
  const auto geometry = crowd();
  const auto rays = random_rays(geometry->bounds, 5000);
  const std::vector<Hit> right = answers(geometry, rays, {});
  std::vector<StreamOptions> ways(5);
  ways[0].treelet_size = 1, ways[0].list_length = 1;
  ways[1].treelet_size = 3, ways[1].list_length = 4;
  ways[2].treelet_size = 1000;
  ways[3].batch_side = 16, ways[3].in_flight = 3;  // twenty batches and more, three of them on the device at a time
  ways[4].batch_side = 4, ways[4].in_flight = 1;
  for (const StreamOptions& way : ways) {
    const std::vector<Hit> hits = answers(geometry, rays, way);
    std::size_t found = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(hits[i].object, right[i].object) << "ray " << i;
      ASSERT_EQ(hits[i].primitive, right[i].primitive) << "ray " << i;
      ASSERT_EQ(hits[i].t, right[i].t) << "ray " << i;
      found += hits[i].hit();
    }
    EXPECT_GT(found, rays.size() / 2);
  }
}

TEST(Stream, AnEmptySceneIsMissed) {
  const auto stream = make_stream_tracer(GeometryBuilder().build(), Precision::robust);
  const std::vector<Ray> rays{down(0, 0)};
  std::vector<Hit> hits(1);
  stream->closest(rays, hits, RayClass::primary);
  EXPECT_FALSE(hits[0].hit());
}

TEST(StreamEntries, AreNeverRoundedUp) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> exponent(-30, 20);
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const auto packed = [](float a, float b) { return glm::unpackHalf2x16(pack_entries({a, b})); };
  for (int i = 0; i < 10000; ++i) {
    const float a = std::exp2(exponent(random)), b = -a;
    const glm::vec2 halves = packed(a, b);
    EXPECT_LE(halves.x, a);
    EXPECT_GE(halves.x, a < 0x1p-14f ? -infinity : std::min(a, 65504.f) * (1 - 0x1p-10f));
    EXPECT_LE(halves.y, b);
  }
  EXPECT_EQ(packed(infinity, std::numeric_limits<float>::quiet_NaN()), glm::vec2(65504, -infinity));
}

TEST(RadixSort, SortsByTheLowBitsAndKeepsTheOrderOfEquals) {
  std::mt19937_64 random(3);
  std::vector<SortKey> keys, spare;
  for (std::uint32_t i = 0; i < 5000; ++i) keys.push_back({random() % 300 << 20 | (i % 7), i});
  std::vector<SortKey> right = keys;
  std::stable_sort(right.begin(), right.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
  radix_sort(keys, spare, 29);
  for (std::size_t i = 0; i < keys.size(); ++i) ASSERT_EQ(keys[i].index, right[i].index);
}

}  // namespace
}  // namespace rayengine
