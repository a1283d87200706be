#include "engine/measure/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "cpu/reference_tracer.h"
#include "engine/measure/bound.h"
#include "engine/measure/rays.h"

namespace rayengine {
namespace {

std::shared_ptr<const Geometry> spheres_and_a_floor() {
  GeometryBuilder builder;
  for (int i = 0; i < 5; ++i) builder.add(QuadricShape{}, 0, Affine::translate({2.5 * i - 5, 0, 0}));
  builder.add(Mesh{{{-8, -4, -1}, {8, -4, -1}, {8, 4, -1}, {-8, 4, -1}}, {}, {{0, 1, 2}, {0, 2, 3}}});
  return builder.build();
}

/// The oracle with a defect of its own, which says that it computes in single precision.
class Defective final : public Tracer {
 public:
  using Defect = std::function<void(std::size_t ray, Hit& hit)>;
  Defective(std::shared_ptr<const Geometry> geometry, Defect defect)
      : exact_(make_reference_tracer(std::move(geometry))), defect_(std::move(defect)) {}

  std::string_view name() const override { return "defective"; }
  Precision precision() const override { return Precision::fast; }
  Limits limits() const override {
    Limits limits;
    limits.triangle_roundoff = limits.quadric_roundoff = 0x1p-24;
    return limits;
  }
  double build_seconds() const override { return 0; }
  std::size_t bytes() const override { return 0; }
  void closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) override {
    std::vector<Hit> answers(rays.size());
    exact_->closest(rays, answers, ray_class);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      answers[i].error = 0;
      const Hit untouched = hits[i];
      defect_(i, answers[i]);
      hits[i] = answers[i].status == unanswered ? untouched : answers[i];
    }
  }
  void any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) override {
    exact_->any(rays, status, ray_class);
  }
  HitLists all(std::span<const Ray> rays) override { return exact_->all(rays); }

  static constexpr std::uint32_t unanswered = 1000;

 private:
  std::unique_ptr<Tracer> exact_;
  Defect defect_;
};

Comparison compare_defective(const std::vector<Ray>& rays, Defective::Defect defect) {
  const auto geometry = spheres_and_a_floor();
  Defective tracer(geometry, std::move(defect));
  return compare(tracer, *make_reference_tracer(geometry), *geometry, rays, RayClass::primary);
}

/// Straight down on the spheres' tops at t = 1, between them on the floor at t = 3, and beside it.
const std::vector<Ray> plain_rays{{{-5, 0, 2}, 0, {0, 0, -1}, infinity},
                                  {{0, 0.25, 2}, 0, {0, 0, -1}, infinity},
                                  {{1.25, -3, 2}, 0, {0, 0, -1}, infinity},
                                  {{1.25, 9, 2}, 0, {0, 0, -1}, infinity}};

TEST(Compare, MeasuresPointsAndNormals) {
  const Comparison c = compare_defective({{{1.25, -3, 2}, 0, {0, 0, -4}, infinity}}, [](std::size_t, Hit& hit) {
    hit.t += 0.25;
    hit.normal = glm::vec3(0, 0.6f, 0.8f);
  });
  EXPECT_DOUBLE_EQ(c.max_t_error, 0.25 / 0.75);
  EXPECT_DOUBLE_EQ(c.max_point_error, 1);
  EXPECT_NEAR(c.max_normal_error, std::acos(0.8), 1e-6);
  EXPECT_EQ(c.p999_point_error, c.max_point_error);
  EXPECT_EQ(c.p999_normal_error, c.max_normal_error);
}

TEST(Compare, CountsBoundsThatAreBroken) {
  const Comparison c = compare_defective(plain_rays, [](std::size_t i, Hit& hit) {
    hit.error = i == 0 ? 1e-3 : 1e-9;
    if (hit.hit()) hit.t += 1e-6;
  });
  EXPECT_EQ(c.bound_violations, 2u);
  EXPECT_EQ(c.beyond_bounds, 2u);
}

TEST(Compare, WithoutAnOracleNothingIsExcused) {
  const auto geometry = spheres_and_a_floor();
  std::vector<Hit> exact(plain_rays.size());
  make_reference_tracer(geometry)->closest(plain_rays, exact, RayClass::primary);
  std::vector<Hit> hits = exact;
  hits[1] = {};
  for (Hit& hit : hits) hit.error = 0, hit.t += 1e-3;
  const Comparison c = judge({*geometry, {}, plain_rays, RayClass::primary, hits, exact}, nullptr);
  EXPECT_EQ(c.false_misses, 1u);
  EXPECT_EQ(c.ambiguous, 0u);
  EXPECT_EQ(c.beyond_bounds, 1u) << "a t that states no error breaks none";
}

TEST(Compare, FindsNothingWhereNothingIs) {
  const Comparison c = compare_defective(plain_rays, [](std::size_t, Hit&) {});
  EXPECT_EQ(c.rays, 4u);
  EXPECT_EQ(c.hits, 3u);
  EXPECT_EQ(c.wrong_ids + c.false_hits + c.false_misses + c.beyond_bounds + c.nans, 0u);
  EXPECT_EQ(c.max_t_error, 0);
  EXPECT_EQ(c.ulps, std::vector<std::uint64_t>{3});
}

TEST(Compare, CountsEveryKindOfDifferenceAndNamesTheRays) {
  const Comparison c = compare_defective(plain_rays, [](std::size_t ray, Hit& hit) {
    if (ray == 0) hit.object = 1;
    if (ray == 2) hit = Hit{};
    if (ray == 3) hit = Hit{.t = 1, .object = 0, .primitive = 0, .status = status_hit};
  });
  EXPECT_EQ(c.false_misses, 1u);
  EXPECT_EQ(c.false_hits, 1u);
  EXPECT_EQ(c.beyond_bounds, 3u);
  EXPECT_EQ(c.wrong_ids, 1u);
  EXPECT_EQ(c.ambiguous, 0u) << "the ray meets object 1 nowhere, so that it is no surface that coincides";
  EXPECT_EQ(c.first, (std::vector<std::size_t>{0, 2, 3}));
}

TEST(Compare, AcceptsTWithinRoundingOnly) {
  for (const double error : {0x1p-23, 1e-3}) {
    const Comparison c = compare_defective(plain_rays, [&](std::size_t, Hit& hit) { hit.t *= 1 + error; });
    EXPECT_EQ(c.beyond_bounds, error < 1e-6 ? 0u : 3u);
    EXPECT_NEAR(c.max_t_error, error, 1e-12);
    EXPECT_EQ(c.wrong_ids, 0u);
  }
}

TEST(Compare, HoldsAHitToTheErrorThatItStates) {
  const auto stated = [](double error) {
    return [=](std::size_t, Hit& hit) { hit.t *= 1 + 0x1p-30, hit.error = error; };
  };
  EXPECT_EQ(compare_defective(plain_rays, stated(1e-8)).beyond_bounds, 0u);
  EXPECT_EQ(compare_defective(plain_rays, stated(1e-10)).beyond_bounds, 3u);
}

TEST(Compare, SortsDifferencesIntoFloatUlps) {
  // t = 1 at the first ray, where a float ulp is 2^-23.
  const std::pair<double, std::size_t> bins[]{{1, 1}, {2, 2}, {3, 3}, {4, 3}, {5, 4}, {8, 4}, {9, 5}};
  for (const auto& bin : bins) {
    const Comparison c =
        compare_defective({plain_rays[0]}, [&](std::size_t, Hit& hit) { hit.t += bin.first * 0x1p-23; });
    ASSERT_EQ(c.ulps.size(), bin.second + 1) << bin.first;
    EXPECT_EQ(c.ulps.back(), 1u);
  }
}

TEST(Compare, NoticesAnswersThatAreNumbersInNoSense) {
  const Comparison nan = compare_defective(plain_rays, [](std::size_t ray, Hit& hit) {
    if (ray == 0) hit.normal.y = std::nanf("");
    if (ray == 1) hit.t = std::nan("");
  });
  EXPECT_EQ(nan.nans, 2u);
  EXPECT_EQ(nan.beyond_bounds, 2u);
  const Comparison ids =
      compare_defective(plain_rays, [](std::size_t ray, Hit& hit) { hit.object = ray == 0 ? 77 : hit.object; });
  EXPECT_EQ(ids.beyond_bounds, 1u);
  const Comparison part =
      compare_defective(plain_rays, [](std::size_t ray, Hit& hit) { hit.primitive = ray == 0 ? 1 : hit.primitive; });
  EXPECT_EQ(part.beyond_bounds, 1u);
}

TEST(Compare, NoticesAnswersThatWereNeverWritten) {
  const Comparison c = compare_defective(plain_rays, [](std::size_t ray, Hit& hit) {
    if (ray >= 2) hit.status = Defective::unanswered;
  });
  EXPECT_EQ(c.beyond_bounds, 2u);
}

TEST(Compare, NoticesInvalidRaysThatWereNotRefused) {
  std::vector<Ray> rays = plain_rays;
  rays[1].direction = glm::dvec3(0);
  EXPECT_EQ(compare_defective(rays, [](std::size_t, Hit&) {}).beyond_bounds, 0u);
  const Comparison c = compare_defective(rays, [](std::size_t ray, Hit& hit) {
    if (ray == 1) hit = Hit{};
  });
  EXPECT_EQ(c.beyond_bounds, 1u);
}

TEST(Compare, ForgivesWhatTheExactAnswerItselfIsUnsureOf) {
  const std::vector<Ray> rays{{{-5, 1 - 1e-9, 2}, 0, {0, 0, -1}, infinity},       // nearly misses a sphere
                              {{-5, 1 + 1e-9, 2}, 0, {0, 0, -1}, infinity},       // nearly hits it
                              {{-8 + 1e-9, 3, 2}, 0, {0, 0, -1}, infinity},       // the floor's rim
                              {{1.25, -3, 2}, 0, {0, 0, -1}, 3 + 1e-9},           // the interval's end
                              {{1.25, -3, -1 + 1e-9}, 0, {0, 0, -1}, infinity}};  // starts on the floor
  const Comparison c = compare_defective(rays, [](std::size_t ray, Hit& hit) {
    if (ray == 0) hit = Hit{.t = 3, .object = 5, .primitive = 1, .status = status_hit};
    if (ray == 1) hit = Hit{.t = 2, .object = 0, .primitive = 0, .status = status_hit};
    if (ray >= 2) hit = Hit{};
  });
  EXPECT_EQ(c.wrong_ids, 2u);
  EXPECT_EQ(c.false_misses, 3u);
  EXPECT_EQ(c.ambiguous, 5u);
  EXPECT_EQ(c.beyond_bounds, 0u);
}

/// An octahedron's upper half over a floor that is split in two triangles.
std::shared_ptr<const Geometry> tent() {
  GeometryBuilder builder;
  builder.add(Mesh{{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}},
                   {},
                   {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {1, 3, 2}, {1, 4, 3}}});
  return builder.build();
}

Comparison compare_on_tent(const Ray& ray, const Hit& answer) {
  const auto geometry = tent();
  Defective tracer(geometry, [&](std::size_t, Hit& hit) { hit = answer; });
  return compare(tracer, *make_reference_tracer(geometry), *geometry, {&ray, 1}, RayClass::primary);
}

TEST(Compare, ExcusesAnyTriangleAtAVertexButNoRayThatSlipsThrough) {
  const Ray down{{0, 0, 3}, 0, {0, 0, -1}, infinity};
  const auto answer = [](double t, std::uint32_t triangle) {
    return Hit{.t = t, .object = 0, .primitive = triangle, .status = status_hit};
  };
  EXPECT_EQ(compare_on_tent(down, answer(2, 3)).ambiguous, 1u);
  EXPECT_EQ(compare_on_tent(down, answer(3, 4)).beyond_bounds, 1u) << "the floor within";
  EXPECT_EQ(compare_on_tent(down, Hit{}).beyond_bounds, 1u) << "the void beyond";
  EXPECT_EQ(compare_on_tent(down, answer(2.5, 3)).beyond_bounds, 1u) << "not where the triangle is";
}

TEST(Compare, DoesNotExcuseTheWrongTriangleOfAPlane) {
  const Ray up{{0, -0.5, -1}, 0, {0, 0, 1}, infinity};
  EXPECT_EQ(compare_on_tent(up, Hit{.t = 1, .object = 0, .primitive = 4, .status = status_hit}).beyond_bounds, 1u);
  EXPECT_EQ(compare_on_tent(up, Hit{.t = 1, .object = 0, .primitive = 5, .status = status_hit}).beyond_bounds, 0u);
}

TEST(Compare, GivesTheSameAgain) {
  const auto rays = random_rays({glm::dvec3(-6), glm::dvec3(6)}, 500);
  const auto defect = [](std::size_t ray, Hit& hit) {
    if (ray % 7 == 0)
      hit = Hit{};
    else
      hit.t *= 1 + 0x1p-23 * static_cast<double>(ray % 5);
  };
  const Comparison a = compare_defective(rays, defect), b = compare_defective(rays, defect);
  EXPECT_GT(a.beyond_bounds, 0u);
  EXPECT_EQ(a.beyond_bounds, b.beyond_bounds);
  EXPECT_EQ(a.first, b.first);
  EXPECT_EQ(a.ulps, b.ulps);
  EXPECT_EQ(a.p999_t_error, b.p999_t_error);
}

TEST(RoundingBound, GrowsWithRoundOffDistanceAndSlenderness) {
  const auto geometry = spheres_and_a_floor();
  const Limits single{.triangle_roundoff = 0x1p-24, .quadric_roundoff = 0x1p-24};
  const Limits dbl{.triangle_roundoff = 0x1p-53, .quadric_roundoff = 0x1p-53};
  const Hit sphere{.t = 1, .object = 0, .primitive = 0, .status = status_hit};
  const double near = rounding_bound(*geometry, single, plain_rays[0], sphere);
  EXPECT_GT(near, 0x1p-24);
  EXPECT_LT(near, 1e-4);
  EXPECT_EQ(rounding_bound(*geometry, dbl, plain_rays[0], sphere), near * 0x1p-29);
  Ray far = plain_rays[0];
  far.origin.z = 1e6;
  EXPECT_GT(rounding_bound(*geometry, single, far, sphere), 1e6 * 0x1p-24);

  GeometryBuilder builder;
  builder.add(Mesh{{{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, 1e-4, 0}}, {}, {{0, 1, 2}, {0, 1, 3}}});
  const auto triangles = builder.build();
  const Hit regular{.t = 1, .object = 0, .primitive = 0, .status = status_hit};
  const Hit slender{.t = 1, .object = 0, .primitive = 1, .status = status_hit};
  EXPECT_GT(rounding_bound(*triangles, single, {}, slender), 1000 * rounding_bound(*triangles, single, {}, regular));
}

}  // namespace
}  // namespace rayengine
