// Rays that meet instances together must be answered as if each were alone: in blocks of InstanceWalk::most_rays and at
// their ends, through groups with and without bounds, where instances overlap and where they coincide.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "cpu/bvh_tracer.h"
#include "cpu/instance_walk.h"
#include "cpu/reference_tracer.h"
#include "engine/measure/rays.h"

namespace rayengine {
namespace {

/// The object whose faces all but coincide: its numbers are not moderate, and only certified answers tell them apart.
constexpr std::uint32_t flat = 60;

/// More balls and tetrahedra than a ray's list holds, one through another, some in the same place, and two planes.
std::shared_ptr<const Geometry> crowd() {
  GeometryBuilder small, unbounded, builder;
  small.add(QuadricShape{});
  small.add(Mesh{{{-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}}, {}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}});
  unbounded.add(QuadricShape{QuadricType::plane});
  const auto group = small.build(), floor = unbounded.build();
  for (int i = 0; i < 60; ++i) {
    const int place = i % 50;  // ten are there twice
    const glm::dvec3 at(place % 5, place / 5 % 5, place / 25);
    builder.add(group, Affine::translate(at) * Affine::rotate({1, 2, 3}, 7. * place) * Affine::scale(glm::dvec3(0.8)));
  }
  builder.add(group, Affine::translate({7, 2, 1}) * Affine::scale(glm::dvec3(1, 1, 0x1p-120)));
  builder.add(QuadricShape{}, 0, Affine::translate({2, 2, 0.5}));
  for (const double z : {-2., 4.}) builder.add(floor, Affine::translate({0, 0, z}));
  return builder.build();
}

class CompanyOfRays : public testing::TestWithParam<Precision> {
 protected:
  std::shared_ptr<const Geometry> geometry_ = crowd();
  std::unique_ptr<Tracer> tracer_ = make_bvh_tracer(geometry_, GetParam());
  std::vector<Ray> rays_ = random_rays({{-1, -1, -1}, {6, 6, 3}}, 1000 + InstanceWalk::most_rays / 2);
};
INSTANTIATE_TEST_SUITE_P(Bvh, CompanyOfRays, testing::Values(Precision::robust, Precision::certified),
                         [](const auto& info) { return std::string(to_string(info.param)); });

TEST_P(CompanyOfRays, DoesNotChangeTheNearestHit) {
  std::vector<Hit> together(rays_.size());
  tracer_->closest(rays_, together, RayClass::bounce);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    Hit alone;
    tracer_->closest({&rays_[i], 1}, {&alone, 1}, RayClass::bounce);
    ASSERT_EQ(std::memcmp(&alone, &together[i], sizeof alone), 0) << "ray " << i;
    hits += alone.hit();
  }
  EXPECT_GT(hits, rays_.size() / 2);
}

TEST_P(CompanyOfRays, DoesNotChangeWhetherThereIsAny) {
  for (std::size_t i = 0; i < rays_.size(); ++i) rays_[i].tmax = static_cast<double>(i % 10);
  std::vector<std::uint32_t> together(rays_.size());
  tracer_->any(rays_, together, RayClass::shadow);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    std::uint32_t alone = 77;
    tracer_->any({&rays_[i], 1}, {&alone, 1}, RayClass::shadow);
    ASSERT_EQ(alone, together[i]) << "ray " << i;
    hits += alone == status_hit;
  }
  EXPECT_GT(hits, rays_.size() / 10);
  EXPECT_LT(hits, rays_.size());
}

/// The same as exact arithmetic, which walks no boxes: with intervals of all kinds, and a ray that is none among them.
TEST_P(CompanyOfRays, IsAnsweredAsExactArithmeticDoes) {
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    if (i % 3 == 0) rays_[i].tmin = 3;
    if (i % 7 == 0) rays_[i].tmax = 5;
  }
  rays_[100].direction = {};
  std::vector<Hit> hits(rays_.size()), exact(rays_.size());
  std::vector<std::uint32_t> any(rays_.size());
  tracer_->closest(rays_, hits, RayClass::bounce);
  tracer_->any(rays_, any, RayClass::shadow);
  make_reference_tracer(geometry_)->closest(rays_, exact, RayClass::bounce);
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    EXPECT_EQ(hits[i].object, exact[i].object) << "ray " << i;
    const bool can_tell = GetParam() == Precision::certified || exact[i].object != flat;
    EXPECT_TRUE(!can_tell || hits[i].primitive == exact[i].primitive) << "ray " << i;
    EXPECT_EQ(any[i], exact[i].status & (status_hit | status_invalid)) << "ray " << i;
    if (!exact[i].hit()) continue;
    EXPECT_LE(std::abs(hits[i].t - exact[i].t), GetParam() == Precision::certified ? hits[i].error : 1e-12);
  }
}

/// What all hits say is another path, ray by ray.
TEST_P(CompanyOfRays, FindsTheFirstOfAllHits) {
  std::vector<Hit> nearest(rays_.size());
  tracer_->closest(rays_, nearest, RayClass::bounce);
  const HitLists lists = tracer_->all(rays_);
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    ASSERT_EQ(nearest[i].hit(), lists.offsets[i] < lists.offsets[i + 1]) << "ray " << i;
    if (!nearest[i].hit()) continue;
    const Hit& first = lists.hits[lists.offsets[i]];
    EXPECT_EQ(nearest[i].object, first.object) << "ray " << i;
    EXPECT_EQ(nearest[i].primitive, first.primitive) << "ray " << i;
    EXPECT_NEAR(nearest[i].t, first.t, 1e-12) << "ray " << i;
  }
}

}  // namespace
}  // namespace rayengine
