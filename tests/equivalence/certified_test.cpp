// Precision `certified`: the ids of exact arithmetic, and t within the bound that comes with it, on rays aimed at what
// is hard to decide.

#include <gtest/gtest.h>

#include <cstring>
#include <glm/geometric.hpp>
#include <tuple>

#include "cpu/reference_tracer.h"
#include "engine/measure/rays.h"
#include "engine/tracers.h"
#include "tests/equivalence/cases.h"

namespace rayengine {
namespace {

using test::Case;

constexpr std::uint32_t decided = status_hit | status_invalid | status_tie;

class Certified : public testing::TestWithParam<std::tuple<const char*, Case>> {
 protected:
  const Geometry& geometry() const { return *std::get<Case>(GetParam()).geometry; }
  std::unique_ptr<Tracer> tracer() const {
    const auto& [name, scene] = GetParam();
    return make_tracer(name, scene.geometry, {.precision = Precision::certified});
  }
  std::unique_ptr<Tracer> oracle() const { return make_reference_tracer(std::get<Case>(GetParam()).geometry); }

  void expect_exact(std::span<const Ray> rays) const;
};

std::string text(const Hit& hit) {
  char line[200];
  std::snprintf(line, sizeof line, "object %d part %d t %.17g +- %.3g status %u", static_cast<int>(hit.object),
                static_cast<int>(hit.primitive), hit.t, hit.error, hit.status);
  return line;
}

std::string name_of(const testing::TestParamInfo<Certified::ParamType>& info) {
  return std::get<const char*>(info.param) + ("_" + std::get<Case>(info.param).name);
}
INSTANTIATE_TEST_SUITE_P(Tracers, Certified,
                         testing::Combine(testing::Values("bvh"), testing::ValuesIn(test::all_cases())), name_of);

/// What other tracers propose is proven, and comes out the same to the bit.
class Proposed : public Certified {};
INSTANTIATE_TEST_SUITE_P(Tracers, Proposed,
                         testing::Combine(testing::Values("embree", "stream", "objects", "grid", "cones", "points",
                                                          "hybrid"),
                                          testing::ValuesIn(test::all_cases())),
                         name_of);

TEST_P(Proposed, GivesTheSameBits) {
  const auto tested = tracer(),
             certifier = make_tracer("bvh", std::get<Case>(GetParam()).geometry, {.precision = Precision::certified});
  EXPECT_EQ(tested->precision(), Precision::certified);
  EXPECT_EQ(tested->name(), std::get<const char*>(GetParam()));
  for (const auto& rays : {random_rays(geometry().bounds, 400, 15), aimed_rays(geometry(), 400)}) {
    std::vector<Hit> hits(rays.size()), expected(rays.size());
    tested->closest(rays, hits, RayClass::bounce);
    certifier->closest(rays, expected, RayClass::bounce);
    for (std::size_t i = 0; i < rays.size(); ++i)
      ASSERT_EQ(std::memcmp(&hits[i], &expected[i], sizeof(Hit)), 0)
          << "ray " << i << ": " << text(hits[i]) << ", alone " << text(expected[i]);
  }
}

bool same(const Hit& a, const Hit& exact) {
  const bool decisions =
      (a.status & decided) == (exact.status & decided) && a.object == exact.object && a.primitive == exact.primitive;
  const bool distance = a.t == exact.t || (a.error > 0 && std::abs(a.t - exact.t) <= a.error + exact.error);
  const bool normals = !a.hit() || glm::dot(a.normal, exact.normal) > 1 - 1e-5f;
  return decisions && distance && normals;
}

void expect_same(std::span<const Ray> rays, std::span<const Hit> hits, std::span<const Hit> exact) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (same(hits[i], exact[i])) continue;
    if (++wrong < 4) ADD_FAILURE() << "ray " << i << ": " << text(hits[i]) << ", exactly " << text(exact[i]);
  }
  EXPECT_EQ(wrong, 0u);
}

void Certified::expect_exact(std::span<const Ray> rays) const {
  const auto tested = tracer(), right = oracle();
  std::vector<Hit> hits(rays.size()), exact(rays.size());
  right->closest(rays, exact, RayClass::primary);
  tested->closest(rays, hits, RayClass::primary);
  expect_same(rays, hits, exact);
  std::vector<std::uint32_t> any(rays.size());
  tested->any(rays, any, RayClass::shadow);
  for (std::size_t i = 0; i < rays.size(); ++i)
    ASSERT_EQ(any[i], exact[i].status & (status_hit | status_invalid)) << "ray " << i;
}

TEST_P(Certified, OnRandomRays) { expect_exact(random_rays(geometry().bounds, 2000, 11)); }

TEST_P(Certified, OnAimedRays) { expect_exact(aimed_rays(geometry(), 2000)); }

TEST_P(Certified, FewRandomRaysAreResolved) {
  const auto tested = tracer();
  const auto rays = random_rays(geometry().bounds, 2000, 16);
  std::vector<Hit> hits(rays.size());
  tested->closest(rays, hits, RayClass::bounce);
  EXPECT_LE(tested->resolved_rays(), 2u);
}

TEST_P(Certified, OnRaysFromAfar) {
  const double size = geometry().bounds.finite() ? glm::length(geometry().bounds.size()) : 10;
  for (const double distance : {1e2, 1e4, 1e7}) {
    auto rays = random_rays(geometry().bounds, 300, 6);
    for (Ray& ray : rays) ray.origin -= distance * size * ray.direction;
    expect_exact(rays);
  }
}

/// Intervals that end at a hit, before it and behind it, by a little and exactly.
TEST_P(Certified, OnIntervalsThatEndAtHits) {
  auto rays = random_rays(geometry().bounds, 1000, 12);
  std::vector<Hit> exact(rays.size());
  oracle()->closest(rays, exact, RayClass::primary);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!exact[i].hit()) continue;
    const double t = exact[i].t * (1 + (static_cast<double>(i % 7) - 3) * 0x1p-52);
    (i % 2 ? rays[i].tmin : rays[i].tmax) = t;
  }
  expect_exact(rays);
}

TEST_P(Certified, OnDirectionsOfAnyLength) {
  auto rays = random_rays(geometry().bounds, 600, 13);
  for (std::size_t i = 0; i < rays.size(); ++i)
    rays[i].direction *= std::pow(10., static_cast<double>(i % 7) * 50 - 150);
  expect_exact(rays);
}

TEST_P(Certified, AllHitsAreThoseOfExactArithmetic) {
  for (const auto& rays : {random_rays(geometry().bounds, 600, 14), aimed_rays(geometry(), 600)}) {
    const HitLists hits = tracer()->all(rays), exact = oracle()->all(rays);
    ASSERT_EQ(hits.offsets, exact.offsets);
    for (std::size_t i = 0; i < exact.hits.size(); ++i)
      EXPECT_TRUE(same(hits.hits[i], exact.hits[i])) << text(hits.hits[i]) << ", exactly " << text(exact.hits[i]);
  }
}

}  // namespace
}  // namespace rayengine
