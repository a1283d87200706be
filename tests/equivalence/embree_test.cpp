// Embree against the oracle, on every kind of primitive, with random rays and with rays aimed at what is hard to
// decide.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cpu/embree_tracer.h"
#include "cpu/reference_tracer.h"
#include "engine/measure/compare.h"
#include "engine/measure/rays.h"

namespace rayengine {
namespace {

struct Case {
  std::string name;
  std::shared_ptr<const Geometry> geometry;
  // What single precision may do to 1,500 random rays where nothing is aimed at edges.
  std::size_t differences = 4;
  double t_error = 1e-3;
};

/// Turned, stretched and moved, in another way for every i.
Affine placement(int i) {
  return Affine::translate({3 * std::cos(i), 3 * std::sin(2. * i), .1 * i}) * Affine::rotate({1, i, 2}, 40 * i) *
         Affine::scale({1 + .1 * (i % 5), 1, 1 - .1 * (i % 3)});
}

Case many(const std::string& name, const QuadricShape& shape) {
  GeometryBuilder builder;
  for (int i = 0; i < 24; ++i) builder.add(shape, 0, placement(i));
  return {name, builder.build()};
}

QuadricShape ellipsoid_with_a_box() {
  return {QuadricType::general,
          false,
          {},
          QuadricMatrix{1, .25, 0, 0, 2, 0, .5, 1.5, 0, -1},
          Box{{-1, -.5, -1}, {.5, 1, 1}}};
}

Mesh torus(unsigned rings, unsigned sides) {
  Mesh mesh;
  for (unsigned i = 0; i < rings; ++i)
    for (unsigned k = 0; k < sides; ++k) {
      const double a = 2 * std::numbers::pi * i / rings, b = 2 * std::numbers::pi * k / sides, r = 2 + std::cos(b);
      mesh.positions.push_back({r * std::cos(a), r * std::sin(a), std::sin(b)});
      const unsigned next = (i + 1) % rings * sides, here = i * sides, beside = (k + 1) % sides;
      mesh.triangles.push_back({here + k, next + k, next + beside});
      mesh.triangles.push_back({here + k, next + beside, here + beside});
    }
  return mesh;
}

Case instances() {
  GeometryBuilder inner;
  inner.add(torus(24, 12));
  inner.add(QuadricShape{QuadricType::cone, true, {}, {}, {}}, 0, Affine::translate({0, 0, .5}));
  const auto group = inner.build();
  GeometryBuilder outer;
  for (int i = 0; i < 12; ++i) outer.add(group, placement(i));
  return {"instances", outer.build()};
}

Case mixed() {
  GeometryBuilder builder;
  for (int i = 0; i < 40; ++i) {
    const auto type = static_cast<QuadricType>(i % 9);
    if (type != QuadricType::plane) builder.add(QuadricShape{type, false, {}, {}, {}}, 0, placement(i));
    builder.add(torus(8, 6), 0, placement(i + 3));
  }
  return {"mixed", builder.build()};
}

Case far_away() {
  GeometryBuilder builder;
  for (int i = 0; i < 8; ++i) {
    builder.add(QuadricShape{}, 0, Affine::translate({1e6, 2e6, 0}) * placement(i));
    builder.add(torus(8, 6), 0, Affine::translate({1e6, 2e6, 0}) * placement(i));
  }
  return {"far_away", builder.build(), 300, 1};  // a float's ulp is an eighth here
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (std::size_t i = 0; i + 1 < quadric_type_count; ++i) {
    const auto type = static_cast<QuadricType>(i);
    cases.push_back(many(std::string(to_string(type)), {type, false, {}, {}, {}}));
    if (type >= QuadricType::cylinder && type <= QuadricType::hyperboloid2)
      cases.push_back(many(std::string(to_string(type)) + "_capped", {type, true, {}, {}, {}}));
  }
  cases.push_back(many("general", ellipsoid_with_a_box()));
  cases.push_back(many("clipped_sphere", {QuadricType::sphere, false, std::array{-.5, .75}, {}, {}}));
  GeometryBuilder builder;
  builder.add(torus(64, 32));
  cases.push_back({"torus", builder.build()});
  cases.push_back(instances());
  cases.push_back(mixed());
  cases.push_back(far_away());
  return cases;
}

class Equivalence : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Embree, Equivalence, testing::ValuesIn(all_cases()),
                         [](const auto& info) { return info.param.name; });

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

void expect_equivalent(const Case& c, Precision precision, std::span<const Ray> rays, RayClass ray_class) {
  const auto embree = make_embree_tracer(c.geometry, precision);
  const auto oracle = make_reference_tracer(c.geometry);
  const Comparison result = compare(*embree, *oracle, *c.geometry, rays, ray_class);
  EXPECT_EQ(result.beyond_bounds, 0u) << describe(result, rays, *embree, *oracle);
  EXPECT_EQ(result.nans, 0u);
  EXPECT_GT(result.hits, rays.size() / 20) << "too few hits to prove anything";
}

TEST_P(Equivalence, RobustOnRandomRays) {
  const auto rays = random_rays(GetParam().geometry->bounds, 1500);
  expect_equivalent(GetParam(), Precision::robust, rays, RayClass::primary);
}

TEST_P(Equivalence, RobustOnAimedRays) {
  const auto rays = aimed_rays(*GetParam().geometry, 1500);
  expect_equivalent(GetParam(), Precision::robust, rays, RayClass::bounce);
}

TEST_P(Equivalence, FastOnRandomRays) {
  const auto rays = random_rays(GetParam().geometry->bounds, 1500, 2);
  expect_equivalent(GetParam(), Precision::fast, rays, RayClass::bounce);
}

TEST_P(Equivalence, RobustOnRaysThatLeaveSurfaces) {
  const auto oracle = make_reference_tracer(GetParam().geometry);
  const auto rays = random_rays(GetParam().geometry->bounds, 1500, 3);
  std::vector<Hit> hits(rays.size());
  oracle->closest(rays, hits, RayClass::primary);
  const auto bounces = bounce_rays(*GetParam().geometry, rays, hits);
  ASSERT_FALSE(bounces.empty());
  const auto embree = make_embree_tracer(GetParam().geometry, Precision::robust);
  const Comparison result = compare(*embree, *oracle, *GetParam().geometry, bounces, RayClass::bounce);
  EXPECT_EQ(result.beyond_bounds, 0u) << describe(result, bounces, *embree, *oracle);
}

/// A third of the way along each ray's first hit and beyond: any-hit queries must see the interval, too.
std::vector<Ray> cut_short(std::vector<Ray> rays, std::span<const Hit> hits) {
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (hits[i].hit()) rays[i].tmax = (i % 3 ? 1.01 : 0.99) * hits[i].t;
  return rays;
}

TEST_P(Equivalence, AnyAgreesWithClosest) {
  const auto oracle = make_reference_tracer(GetParam().geometry);
  const auto embree = make_embree_tracer(GetParam().geometry, Precision::robust);
  const auto whole = random_rays(GetParam().geometry->bounds, 1500, 4);
  std::vector<Hit> exact(whole.size());
  oracle->closest(whole, exact, RayClass::primary);
  const auto rays = cut_short(whole, exact);
  std::vector<std::uint32_t> ours(rays.size(), 99), theirs(rays.size(), 99);
  oracle->any(rays, theirs, RayClass::shadow);
  for (const RayClass ray_class : {RayClass::shadow, RayClass::bounce}) {
    embree->any(rays, ours, ray_class);
    std::size_t differences = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) differences += ours[i] != theirs[i];
    EXPECT_LE(differences, GetParam().differences);
  }
  oracle->closest(rays, exact, RayClass::primary);
  for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(theirs[i], exact[i].status & status_hit);
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> ids(const HitLists& lists, std::size_t ray) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> result;
  for (auto k = lists.offsets[ray]; k < lists.offsets[ray + 1]; ++k)
    result.emplace_back(lists.hits[k].object, lists.hits[k].primitive);
  return result;
}

TEST_P(Equivalence, AllGivesTheOraclesLists) {
  const auto rays = random_rays(GetParam().geometry->bounds, 1500, 5);
  const HitLists exact = make_reference_tracer(GetParam().geometry)->all(rays);
  const HitLists ours = make_embree_tracer(GetParam().geometry, Precision::robust)->all(rays);
  ASSERT_EQ(ours.offsets.size(), rays.size() + 1);
  EXPECT_GT(exact.hits.size(), rays.size() / 20);
  std::size_t differences = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool same = ids(ours, i) == ids(exact, i);
    differences += !same;
    for (std::size_t k = 0; same && k < exact.offsets[i + 1] - exact.offsets[i]; ++k) {
      const double t = exact.hits[exact.offsets[i] + k].t;
      EXPECT_NEAR(ours.hits[ours.offsets[i] + k].t, t, GetParam().t_error * (1 + t)) << "ray " << i;
    }
  }
  EXPECT_LE(differences, GetParam().differences);
}

}  // namespace
}  // namespace rayengine
