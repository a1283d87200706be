#include "cpu/bare_embree.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cpu/reference_tracer.h"

namespace rayengine {
namespace {

Mesh floor_mesh() { return {{{-9, -9, -1}, {9, -9, -1}, {9, 9, -1}, {-9, 9, -1}}, {}, {{0, 1, 2}, {0, 2, 3}}}; }

std::shared_ptr<const Geometry> spheres_on_floor() {
  GeometryBuilder builder;
  builder.add(floor_mesh());
  builder.add(QuadricShape{}, 0, Affine::translate({0, 0, 1}) * Affine::scale(glm::dvec3(0.5)));
  builder.add(QuadricShape{}, 0, Affine::translate({3, 0, 0}));
  return builder.build();
}

/// A grid of rays from above, at slants.
std::vector<Ray> grid() {
  std::vector<Ray> rays;
  for (int y = 0; y < 37; ++y)
    for (int x = 0; x < 41; ++x) rays.push_back({{-5 + 0.2501 * x, -5 + 0.2703 * y, 6}, 0, {0.05, 0.02, -1}, infinity});
  return rays;
}

class BareShapes : public testing::TestWithParam<std::tuple<BareShape, RayClass, bool>> {};

TEST_P(BareShapes, FindWhatTheOracleFinds) {
  const auto [shape, ray_class, robust] = GetParam();
  const auto geometry = spheres_on_floor();
  const BareEmbree bare(geometry, shape, robust);
  const std::vector<Ray> rays = grid();
  std::vector<BareHit> hits(rays.size());
  std::vector<std::uint32_t> status(rays.size());
  std::vector<Hit> exact(rays.size());
  bare.closest(rays, hits, ray_class);
  bare.any(rays, status, ray_class);
  make_reference_tracer(geometry)->closest(rays, exact, ray_class);
  std::size_t others = 0, on_spheres = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit hit = bare.hit(hits[i]);
    ASSERT_EQ(hit.hit(), exact[i].hit()) << i;
    ASSERT_EQ(status[i], hit.status) << i;
    if (hit.object != exact[i].object) ++others;
    if (hit.object != exact[i].object || !hit.hit()) continue;
    on_spheres += hit.object > 0;
    EXPECT_EQ(hit.primitive, exact[i].primitive);
    EXPECT_NEAR(hit.t, exact[i].t, 1e-4);
  }
  EXPECT_GT(on_spheres, 40u);
  EXPECT_EQ(others, 0u);
  EXPECT_GT(bare.bytes(), geometry->triangles.size() * sizeof(glm::uvec3));
  EXPECT_GT(bare.build_seconds(), 0);
}

INSTANTIATE_TEST_SUITE_P(All, BareShapes,
                         testing::Combine(testing::Values(BareShape::spheres),
                                          testing::Values(RayClass::primary, RayClass::bounce), testing::Bool()));

TEST(BareEmbree, TrianglesKeepTheirNumbers) {
  GeometryBuilder builder;
  builder.add(floor_mesh(), 0, Affine::translate({0, 0, -7}));
  builder.add(floor_mesh());
  const BareEmbree bare(builder.build(), BareShape::triangles, true);
  const Ray ray{{-1, 1, 5}, 0, {0, 0, -1}, infinity};
  BareHit hit;
  bare.closest({&ray, 1}, {&hit, 1}, RayClass::bounce);
  EXPECT_EQ(bare.hit(hit).object, 1u);
  EXPECT_EQ(bare.hit(hit).primitive, 1u);
  EXPECT_FLOAT_EQ(static_cast<float>(bare.hit(hit).t), 6);
}

TEST(BareEmbree, HoldsOnlyWhatEmbreeKnows) {
  EXPECT_TRUE(BareEmbree::holds(*spheres_on_floor(), BareShape::spheres));
  EXPECT_FALSE(BareEmbree::holds(*spheres_on_floor(), BareShape::triangles));
  GeometryBuilder builder;
  builder.add(QuadricShape{}, 0, Affine::scale({1, 2, 1}));
  EXPECT_FALSE(BareEmbree::holds(*builder.build(), BareShape::spheres));
}

}  // namespace
}  // namespace rayengine
