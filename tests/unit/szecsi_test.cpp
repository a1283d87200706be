#include "engine/measure/szecsi.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "engine/measure/rays.h"
#include "engine/tracers.h"

namespace rayengine {
namespace {

/// What the experiment rests on: so many triangles, and glass in every pixel.
TEST(SzecsiScene, HasItsTrianglesAndFillsTheView) {
  for (const std::size_t triangles : {10, 30, 100, 300, 1000, 3000, 5000, 10000}) {
    const Scene scene = glass_bodies(triangles, 96);
    EXPECT_EQ(scene.geometry->triangles.size(), triangles);
    const auto rays = primary_rays(scene.camera);
    std::vector<Hit> hits(rays.size());
    make_tracer("bvh", scene.geometry)->closest(rays, hits, RayClass::primary);
    EXPECT_TRUE(std::ranges::all_of(hits, &Hit::hit)) << triangles;
  }
}

/// Bodies are closed and wound outward, or glass would not know its inside.
TEST(SzecsiScene, LeavesGlassAsOftenAsItEnters) {
  const Scene scene = glass_bodies(1000, 32);
  const auto rays = primary_rays(scene.camera);
  const HitLists lists = make_tracer("bvh", scene.geometry)->all(rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto first = lists.offsets[i], last = lists.offsets[i + 1];
    ASSERT_EQ((last - first) % 2, 0u);
    ASSERT_LT(glm::dot(glm::vec3(rays[i].direction), lists.hits[first].normal), 0);
    ASSERT_GT(glm::dot(glm::vec3(rays[i].direction), lists.hits[last - 1].normal), 0);
  }
}

}  // namespace
}  // namespace rayengine
