#include "engine/measure/ralovich.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "accel/tracer.h"
#include "engine/measure/rays.h"
#include "engine/tracers.h"

namespace rayengine {
namespace {

TEST(Ralovich, ScenesHaveThePapersSizesAndFillTheView) {
  std::vector<std::uint32_t> sizes;
  for (NamedScene& named : ralovich_scenes()) {
    Scene& scene = named.scene;
    sizes.push_back(scene.geometry->primitive_count);
    scene.camera.size = {40, 40};
    const auto rays = primary_rays(scene.camera);
    std::vector<Hit> hits(rays.size());
    make_tracer("bvh", scene.geometry)->closest(rays, hits, RayClass::primary);
    EXPECT_TRUE(std::ranges::all_of(hits, &Hit::hit)) << named.name;
    const auto shadows = shadow_rays(scene, rays, hits);
    std::vector<std::uint32_t> hidden(shadows.size());
    make_tracer("bvh", scene.geometry)->any(shadows, hidden, RayClass::shadow);
    const auto dark = std::ranges::count(hidden, status_hit);
    EXPECT_EQ(dark > 0, named.name != "room") << named.name;
  }
  EXPECT_EQ(sizes, (std::vector<std::uint32_t>{12, 36, 646, 1024}));
}

TEST(Ralovich, EveryMethodIsTimedInEveryMode) {
  const NamedScene room = ralovich_scenes().front();
  const auto times = time_casts(room, {.runs = 1, .size = {16, 16}});
  std::set<std::tuple<CastMode, std::string, int>> kinds;
  for (const CastTime& t : times) {
    kinds.insert({t.mode, t.method, t.vertex_bytes});
    EXPECT_EQ(t.triangles, 12u);
    EXPECT_GT(t.seconds.elapsed, 0);
  }
  EXPECT_EQ(kinds.size(), 15u);
  EXPECT_TRUE(kinds.contains({CastMode::RT, "points", 64}));
  EXPECT_TRUE(kinds.contains({CastMode::SC, "points_without_gs", 48}));
  EXPECT_TRUE(kinds.contains({CastMode::RC, "fragment", 0}));
}

TEST(Ralovich, StagesShareTheWork) {
  const auto shares = share_of_stages(ralovich_scenes().front(), {.runs = 1, .size = {16, 16}});
  ASSERT_EQ(shares.size(), 3u);
  for (const StageShares& s : shares) {
    EXPECT_NEAR(s.vertex + s.geometry + s.fragment, 100, 1e-6);
    for (const double share : {s.vertex, s.geometry, s.fragment}) EXPECT_TRUE(share >= 0 && share <= 100);
  }
}

TEST(Ralovich, MeshesAreLitAndOthersRefused) {
  Scene scene = ralovich_scenes().front().scene;
  scene.lights.clear();
  const Scene lit = lit_as_ralovich(scene);
  EXPECT_EQ(lit.lights.size(), 1u);
  EXPECT_EQ(lit.materials.front().reflect, .25f);
  GeometryBuilder builder;
  builder.add(QuadricShape{});
  scene.geometry = builder.build();
  EXPECT_THROW(lit_as_ralovich(scene), Error);
}

}  // namespace
}  // namespace rayengine
