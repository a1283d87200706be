#include <gtest/gtest.h>

#include <cmath>

#include "cpu/embree_tracer.h"

namespace rayengine {
namespace {

std::unique_ptr<Tracer> tracer_of(GeometryBuilder& builder, Precision precision = Precision::robust) {
  return make_embree_tracer(builder.build(), precision);
}

Hit closest(Tracer& tracer, const Ray& ray, RayClass ray_class = RayClass::primary) {
  Hit hit;
  tracer.closest({&ray, 1}, {&hit, 1}, ray_class);
  return hit;
}

TEST(Embree, HitsASphereInPacketsAndAlone) {
  GeometryBuilder builder;
  builder.add(QuadricShape{});
  const auto tracer = tracer_of(builder);
  for (RayClass c : {RayClass::primary, RayClass::bounce}) {
    const Hit hit = closest(*tracer, {{0.5, 0, -5}, 0, {0, 0, 1}, infinity}, c);
    EXPECT_EQ(hit.status, status_hit);
    EXPECT_NEAR(hit.t, 5 - std::sqrt(0.75), 1e-15);
    EXPECT_NEAR(hit.normal.x, 0.5, 1e-7);
    EXPECT_EQ(hit.object, 0u);
    EXPECT_FALSE(closest(*tracer, {{1.5, 0, -5}, 0, {0, 0, 1}, infinity}, c).hit());
  }
}

TEST(Embree, KeepsDoublePrecisionFromFarAway) {
  GeometryBuilder builder;
  builder.add(QuadricShape{});
  const auto tracer = tracer_of(builder);
  const Hit hit = closest(*tracer, {{-1e7, 0.095, 0}, 0, {1, 0, 0}, infinity});
  EXPECT_NEAR(hit.t, 1e7 - std::sqrt(1 - 0.095 * 0.095), 1e-8);
  const Hit grazing = closest(*tracer, {{-1e7, 1 - 1e-9, 0}, 0, {1, 0, 0}, infinity});
  EXPECT_TRUE(grazing.hit());
  EXPECT_FALSE(closest(*tracer, {{-1e7, 1 + 1e-9, 0}, 0, {1, 0, 0}, infinity}).hit());
}

TEST(Embree, AnswersInvalidRaysWithAMiss) {
  GeometryBuilder builder;
  builder.add(QuadricShape{});
  const auto tracer = tracer_of(builder);
  const double nan = std::nan("");
  const Ray bad[] = {{{nan, 0, 0}, 0, {0, 0, 1}, 1},      {{0, 0, 0}, 0, {0, 0, 0}, 1},
                     {{0, 0, 0}, 2, {0, 0, 1}, 1},        {{0, 0, infinity}, 0, {0, 0, 1}, 1},
                     {{0, 0, 0}, 0, {0, infinity, 1}, 1}, {{0, 0, 0}, nan, {0, 0, 1}, 1}};
  for (RayClass c : {RayClass::primary, RayClass::bounce}) {
    std::vector<Hit> hits(std::size(bad));
    std::vector<std::uint32_t> any(std::size(bad));
    tracer->closest(bad, hits, c);
    tracer->any(bad, any, c);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      EXPECT_EQ(hits[i].status, status_invalid) << i;
      EXPECT_EQ(hits[i].t, infinity) << i;
      EXPECT_EQ(any[i], status_invalid) << i;
    }
  }
}

TEST(Embree, TakesExtremeButValidRays) {
  GeometryBuilder builder;
  builder.add(QuadricShape{});
  const auto tracer = tracer_of(builder);
  EXPECT_FALSE(closest(*tracer, {{1e30, 0, 0}, 0, {0, 0, 1}, infinity}).hit());
  EXPECT_NEAR(closest(*tracer, {{0, 0, -5}, 0, {0, 0, 1e30}, infinity}).t, 4e-30, 1e-44);
  EXPECT_NEAR(closest(*tracer, {{0, 0, -5}, 0, {0, 0, 1e-30}, infinity}).t, 4e30, 1e16);
  EXPECT_NEAR(closest(*tracer, {{0, 0, 5}, -10, {0, 0, 1}, infinity}).t, -6, 1e-14);
}

TEST(Embree, InstancesShareAGroupAndNumberItsPrimitives) {
  GeometryBuilder inner;
  inner.add(QuadricShape{.type = QuadricType::cylinder, .capped = true}, 7);
  inner.add(Mesh{{{-1, -1, 3}, {1, -1, 3}, {0, 1, 3}}, {}, {{0, 1, 2}}}, 8);
  const auto group = inner.build();
  GeometryBuilder middle;
  middle.add(QuadricShape{}, 9, Affine::translate({100, 0, 0}));
  middle.add(group, Affine::translate({50, 0, 0}));
  middle.add(QuadricShape{}, 10, Affine::translate({200, 0, 0}));
  GeometryBuilder builder;
  builder.add(QuadricShape{}, 0, Affine::translate({0, 0, -20}));
  builder.add(middle.build(), Affine::translate({0, 10, 0}) * Affine::scale({2, 2, 2}));
  const auto geometry = builder.build();
  const auto tracer = make_embree_tracer(geometry, Precision::robust);
  const auto down = [&](double x) {
    return closest(*tracer, {{x, 10, 100}, 0, {0, 0, -1}, infinity}, RayClass::bounce);
  };
  const Hit triangle = down(100);
  EXPECT_NEAR(triangle.t, 94, 1e-4);
  EXPECT_EQ(triangle.object, 1u);
  EXPECT_EQ(triangle.primitive, 4u);  // a sphere, then a capped cylinder of three
  EXPECT_EQ(resolve(*geometry, 1, 4).geometry, group.get());
  EXPECT_EQ(resolve(*geometry, 1, 4).object, 1u);
  const Hit last = down(400);
  EXPECT_NEAR(last.t, 98, 1e-12);
  EXPECT_EQ(last.primitive, 5u);
  EXPECT_EQ(resolve(*geometry, 1, 5).object, 2u);
  EXPECT_EQ(down(200).primitive, 0u);
}

TEST(Embree, AllHitsAreSortedAndComplete) {
  GeometryBuilder builder;
  builder.add(QuadricShape{.type = QuadricType::cylinder, .capped = true});
  builder.add(QuadricShape{}, 0, Affine::translate({0, 0, 4}));
  builder.add(Mesh{{{-1, -1, 2}, {1, -1, 2}, {0, 1, 2}}, {}, {{0, 1, 2}}});
  const auto tracer = tracer_of(builder);
  const Ray ray{{0.25, 0.125, -1}, 0, {0, 0, 1}, infinity};
  const HitLists lists = tracer->all({&ray, 1});
  ASSERT_EQ(lists.offsets, (std::vector<std::uint64_t>{0, 5}));
  const std::uint32_t objects[] = {0, 0, 2, 1, 1}, parts[] = {1, 2, 0, 0, 0};
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(lists.hits[static_cast<std::size_t>(i)].object, objects[i]);
    EXPECT_EQ(lists.hits[static_cast<std::size_t>(i)].primitive, parts[i]);
  }
}

}  // namespace
}  // namespace rayengine
