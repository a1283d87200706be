// Every tracer against the oracle, on every kind of primitive, with random rays and with rays aimed at what is hard to
// decide.

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <tuple>

#include "engine/measure/compare.h"
#include "engine/measure/rays.h"
#include "engine/tracers.h"
#include "gpu/grid/grid_tracer.h"
#include "tests/equivalence/cases.h"
#include "tests/equivalence/oracle.h"

namespace rayengine {
namespace {

using test::Case;

/// A tracer's name, or how it goes about it where software does not by itself, and a scene.
class Equivalence : public testing::TestWithParam<std::tuple<const char*, Case>> {
 protected:
  const Case& scene() const { return std::get<Case>(GetParam()); }
  const Geometry& geometry() const { return *scene().geometry; }

  std::unique_ptr<Tracer> tracer(Precision precision) const {
    const std::string name = std::get<const char*>(GetParam());
    if (name == "grid_in_passes") return make_grid_tracer(scene().geometry, precision, {.policy = GridPolicy{}});
    return make_tracer(name, scene().geometry, {.precision = precision});
  }

  Tracer& oracle() const { return test::oracle_on(scene().geometry); }

  void expect_equivalent(Precision precision, std::span<const Ray> rays, RayClass ray_class, std::uint64_t leaks = 0);

  /// Embree's robust mode lets through a few of the rays that pass a vertex exactly.
  std::uint64_t leaks(std::size_t rays) const {
    const bool triangles = !geometry().triangles.empty() || !geometry().groups.empty();
    return triangles && std::get<const char*>(GetParam()) == std::string("embree") ? rays / 400 : 0;
  }
};
std::string name_of(const testing::TestParamInfo<Equivalence::ParamType>& info) {
  return std::get<const char*>(info.param) + ("_" + std::get<Case>(info.param).name);
}
INSTANTIATE_TEST_SUITE_P(Tracers, Equivalence,
                         testing::Combine(testing::Values("embree", "bvh", "stream", "objects", "cones", "grid",
                                                          "grid_in_passes", "points"),
                                          testing::ValuesIn(test::all_cases())),
                         name_of);

/// Those that also compute in single precision.
class FastEquivalence : public Equivalence {};
INSTANTIATE_TEST_SUITE_P(Tracers, FastEquivalence,
                         testing::Combine(testing::Values("embree", "stream", "objects", "cones", "grid", "points"),
                                          testing::ValuesIn(test::all_cases())),
                         name_of);

std::string describe(const Comparison& c, std::span<const Ray> rays, Tracer& tracer, Tracer& oracle) {
  std::string text = std::to_string(c.wrong_ids) + " wrong ids, " + std::to_string(c.false_hits) + " false hits, " +
                     std::to_string(c.false_misses) + " false misses, " + std::to_string(c.ambiguous) +
                     " ambiguous; first:";
  for (const std::size_t i : c.first) {
    Hit a, b;
    tracer.closest(rays.subspan(i, 1), {&a, 1}, RayClass::bounce);
    oracle.closest(rays.subspan(i, 1), {&b, 1}, RayClass::bounce);
    char line[300];
    std::snprintf(line, sizeof line, "\n  ray %zu: object %d part %d t %.17g, exactly object %d part %d t %.17g", i,
                  static_cast<int>(a.object), static_cast<int>(a.primitive), a.t, static_cast<int>(b.object),
                  static_cast<int>(b.primitive), b.t);
    text += line;
  }
  return text;
}

void Equivalence::expect_equivalent(Precision precision, std::span<const Ray> rays, RayClass ray_class,
                                    std::uint64_t leaks) {
  const auto tested = tracer(precision);
  const Comparison result = compare(*tested, oracle(), geometry(), rays, ray_class);
  EXPECT_LE(result.beyond_bounds, leaks) << describe(result, rays, *tested, oracle());
  EXPECT_EQ(result.nans, 0u);
  EXPECT_GT(result.hits, rays.size() / 20) << "too few hits to prove anything";
}

TEST_P(Equivalence, RobustOnRandomRays) {
  expect_equivalent(Precision::robust, random_rays(geometry().bounds, 1500), RayClass::primary);
}

TEST_P(Equivalence, RobustOnAimedRays) {
  expect_equivalent(Precision::robust, aimed_rays(geometry(), 1500), RayClass::bounce, leaks(1500));
}

TEST_P(FastEquivalence, OnRandomRays) {
  expect_equivalent(Precision::fast, random_rays(geometry().bounds, 1500, 2), RayClass::bounce);
}

/// Tracers in single precision bring such rays nearer first, and must not lose what lies on the way.
TEST_P(Equivalence, RobustOnRaysFromAfar) {
  auto rays = random_rays(geometry().bounds, 500, 6);
  const double distance = geometry().bounds.finite() ? 100 * glm::length(geometry().bounds.size()) : 1000;
  for (Ray& ray : rays) ray.origin -= distance * ray.direction;
  expect_equivalent(Precision::robust, rays, RayClass::primary);
  expect_equivalent(Precision::robust, rays, RayClass::bounce);
}

TEST_P(Equivalence, RobustOnRaysThatLeaveSurfaces) {
  const auto rays = random_rays(geometry().bounds, 1500, 3);
  std::vector<Hit> hits(rays.size());
  oracle().closest(rays, hits, RayClass::primary);
  const auto bounces = bounce_rays(geometry(), rays, hits);
  ASSERT_FALSE(bounces.empty());
  const auto tested = tracer(Precision::robust);
  const Comparison result = compare(*tested, oracle(), geometry(), bounces, RayClass::bounce);
  EXPECT_EQ(result.beyond_bounds, 0u) << describe(result, bounces, *tested, oracle());
}

/// A third of the way along each ray's first hit and beyond: any-hit queries must see the interval, too.
std::vector<Ray> cut_short(std::vector<Ray> rays, std::span<const Hit> hits) {
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (hits[i].hit()) rays[i].tmax = (i % 3 ? 1.01 : 0.99) * hits[i].t;
  return rays;
}

TEST_P(Equivalence, AnyAgreesWithClosest) {
  const auto tested = tracer(Precision::robust);
  const auto whole = random_rays(geometry().bounds, 1500, 4);
  std::vector<Hit> exact(whole.size());
  oracle().closest(whole, exact, RayClass::primary);
  const auto rays = cut_short(whole, exact);
  std::vector<std::uint32_t> ours(rays.size(), 99), theirs(rays.size(), 99);
  oracle().any(rays, theirs, RayClass::shadow);
  for (const RayClass ray_class : {RayClass::shadow, RayClass::bounce}) {
    tested->any(rays, ours, ray_class);
    std::size_t differences = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) differences += ours[i] != theirs[i];
    EXPECT_LE(differences, scene().differences);
  }
  oracle().closest(rays, exact, RayClass::primary);
  for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(theirs[i], exact[i].status & status_hit);
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> ids(const HitLists& lists, std::size_t ray) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> result;
  for (auto k = lists.offsets[ray]; k < lists.offsets[ray + 1]; ++k)
    result.emplace_back(lists.hits[k].object, lists.hits[k].primitive);
  return result;
}

TEST_P(Equivalence, AllGivesTheOraclesLists) {
  const auto rays = random_rays(geometry().bounds, 1500, 5);
  const HitLists exact = oracle().all(rays);
  const HitLists ours = tracer(Precision::robust)->all(rays);
  ASSERT_EQ(ours.offsets.size(), rays.size() + 1);
  EXPECT_GT(exact.hits.size(), rays.size() / 20);
  std::size_t differences = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool same = ids(ours, i) == ids(exact, i);
    differences += !same;
    for (std::size_t k = 0; same && k < exact.offsets[i + 1] - exact.offsets[i]; ++k) {
      const double t = exact.hits[exact.offsets[i] + k].t;
      EXPECT_NEAR(ours.hits[ours.offsets[i] + k].t, t, scene().t_error * (1 + t)) << "ray " << i;
    }
  }
  EXPECT_LE(differences, scene().differences);
}

}  // namespace
}  // namespace rayengine
