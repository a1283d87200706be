#include "engine/query.h"

#include <gtest/gtest.h>

#include <atomic>

#include "cpu/embree_tracer.h"
#include "cpu/reference_tracer.h"

namespace rayengine {
namespace {

std::shared_ptr<const Geometry> two_spheres() {
  GeometryBuilder builder;
  builder.add(QuadricShape{});
  builder.add(QuadricShape{}, 0, Affine::translate({0, 0, 5}));
  return builder.build();
}

/// Along z, over more than one batch, some beside the spheres and one that is invalid.
std::vector<Ray> rays_along_z(std::size_t count) {
  std::vector<Ray> rays(count);
  for (std::size_t i = 0; i < count; ++i)
    rays[i].origin = {1.5 * static_cast<double>(i) / static_cast<double>(count), 0, -3};
  rays[count / 2].direction = glm::dvec3(0);
  return rays;
}

bool same(const Hit& a, const Hit& b) {
  return a.t == b.t && a.object == b.object && a.primitive == b.primitive && a.status == b.status;
}

TEST(Query, BatchesAnswerAsOneCallDoes) {
  const auto tracer = make_embree_tracer(two_spheres(), Precision::robust);
  const std::vector<Ray> rays = rays_along_z(3 * tracer->limits().batch + 17);
  std::vector<Hit> once(rays.size()), batched(rays.size());
  std::vector<std::uint32_t> once_any(rays.size()), batched_any(rays.size());
  tracer->closest(rays, once, RayClass::primary);
  tracer->any(rays, once_any, RayClass::primary);
  std::atomic<std::size_t> done = 0;
  closest(*tracer, rays, batched, RayClass::primary, [&](std::size_t n) { done += n; });
  any(*tracer, rays, batched_any, RayClass::primary);
  EXPECT_EQ(done, rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_TRUE(same(once[i], batched[i])) << i;
  EXPECT_EQ(once_any, batched_any);
}

TEST(Query, ListsOfBatchesAreJoined) {
  const auto tracer = make_embree_tracer(two_spheres(), Precision::robust);
  const std::vector<Ray> rays = rays_along_z(2 * tracer->limits().batch + 5);
  const HitLists once = tracer->all(rays), batched = all(*tracer, rays);
  EXPECT_EQ(once.offsets, batched.offsets);
  ASSERT_EQ(once.hits.size(), batched.hits.size());
  EXPECT_GT(once.hits.size(), rays.size());
  for (std::size_t i = 0; i < once.hits.size(); ++i) ASSERT_TRUE(same(once.hits[i], batched.hits[i])) << i;
}

TEST(Query, NoRaysGiveOneOffset) {
  const auto tracer = make_embree_tracer(two_spheres(), Precision::robust);
  EXPECT_EQ(all(*tracer, {}).offsets, std::vector<std::uint64_t>{0});
}

}  // namespace
}  // namespace rayengine
