#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "accel/random.h"
#include "cpu/bvh_tracer.h"
#include "cpu/embree_tracer.h"
#include "cpu/reference_tracer.h"
#include "engine/measure/rays.h"

namespace rayengine {
namespace {

enum class Kind { embree, quick_embree, bvh, loop };

/// What all tracers of the processor promise at `robust`, however they are built.
class CpuTracer : public testing::TestWithParam<Kind> {
 protected:
  static std::unique_ptr<Tracer> tracer_of(std::shared_ptr<const Geometry> geometry) {
    if (GetParam() == Kind::bvh) return make_bvh_tracer(std::move(geometry), Precision::robust);
    if (GetParam() == Kind::loop) return make_loop_tracer(std::move(geometry));
    const Build build = GetParam() == Kind::quick_embree ? Build::quick : Build::thorough;
    return make_embree_tracer(std::move(geometry), Precision::robust, build);
  }
  static std::unique_ptr<Tracer> tracer_of(GeometryBuilder& builder) { return tracer_of(builder.build()); }
};
std::string name_of(const testing::TestParamInfo<Kind>& info) {
  return std::array{"embree", "quick_embree", "bvh", "loop"}[static_cast<std::size_t>(info.param)];
}
INSTANTIATE_TEST_SUITE_P(All, CpuTracer, testing::Values(Kind::embree, Kind::quick_embree, Kind::bvh, Kind::loop),
                         name_of);

Hit closest(Tracer& tracer, const Ray& ray, RayClass ray_class = RayClass::primary) {
  Hit hit;
  tracer.closest({&ray, 1}, {&hit, 1}, ray_class);
  return hit;
}

TEST_P(CpuTracer, HitsASphereInPacketsAndAlone) {
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

TEST_P(CpuTracer, KeepsDoublePrecisionFromFarAway) {
  GeometryBuilder builder;
  builder.add(QuadricShape{});
  const auto tracer = tracer_of(builder);
  const Hit hit = closest(*tracer, {{-1e7, 0.095, 0}, 0, {1, 0, 0}, infinity});
  EXPECT_NEAR(hit.t, 1e7 - std::sqrt(1 - 0.095 * 0.095), 1e-8);
  const Hit grazing = closest(*tracer, {{-1e7, 1 - 1e-9, 0}, 0, {1, 0, 0}, infinity});
  EXPECT_TRUE(grazing.hit());
  EXPECT_FALSE(closest(*tracer, {{-1e7, 1 + 1e-9, 0}, 0, {1, 0, 0}, infinity}).hit());
}

/// Embree leaves out instances whose boxes reach further than it takes.
TEST_P(CpuTracer, SeesPlanesThroughTurnedAndScaledInstances) {
  for (const double scale : {1e-3, 1.0, 1e3}) {
    GeometryBuilder group, builder;
    group.add(QuadricShape{.type = QuadricType::plane});
    const Affine map = Affine::rotate({1, 0, 0.5}, 20) * Affine::scale(glm::dvec3(scale));
    builder.add(group.build(), map);
    builder.add(QuadricShape{}, 0, Affine::translate({1e3, 0, 0}));
    const auto tracer = tracer_of(builder);
    const glm::dvec3 normal = map.linear * glm::dvec3(0, 0, 1) / scale;
    for (const double aside : {0.0, 5.0, 1e4}) {
      const Ray ray{{aside, 0, 3}, 0, {0, 0, -1}, infinity};
      EXPECT_NEAR(closest(*tracer, ray).t, glm::dot(ray.origin, normal) / normal.z, 1e-11) << scale << ' ' << aside;
    }
  }
}

/// Its corners lie on a line but for the last bit of one: found by `rayengine stress`, where `bvh` answered t = 1.0032
/// and a normal of NaN.
TEST_P(CpuTracer, DoesNotHitATriangleInWhichDoublesSeeNoPlane) {
  const double x = -0x1.76cf5d0b0995fp-3, y = -0x1.76cf5d0b09958p-3;
  GeometryBuilder builder;
  builder.add(
      Mesh{{{0, 0, -1}, {x / 2, y / 2, -0x1.f746ea3a45f8ap-1}, {x, y, -0x1.ee8dd4748bf14p-1}}, {}, {{0, 1, 2}}});
  const Ray ray{{0x1.ea0d07993fd1dp-8, 0x1.742eecd0ee171p-8, 0x1.c1b3dd590def4p-7},
                0,
                {-0x1.ccf53277fff9bp-5, -0x1.be56166a1f74ep-5, -0x1.fe6d551de6872p-1},
                infinity};
  EXPECT_FALSE(closest(*tracer_of(builder), ray).hit());
}

TEST_P(CpuTracer, AnswersInvalidRaysWithAMiss) {
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

TEST_P(CpuTracer, TakesExtremeButValidRays) {
  GeometryBuilder builder;
  builder.add(QuadricShape{});
  const auto tracer = tracer_of(builder);
  EXPECT_FALSE(closest(*tracer, {{1e30, 0, 0}, 0, {0, 0, 1}, infinity}).hit());
  EXPECT_NEAR(closest(*tracer, {{0, 0, -5}, 0, {0, 0, 1e30}, infinity}).t, 4e-30, 1e-44);
  EXPECT_NEAR(closest(*tracer, {{0, 0, -5}, 0, {0, 0, 1e-30}, infinity}).t, 4e30, 1e16);
  EXPECT_NEAR(closest(*tracer, {{0, 0, 5}, -10, {0, 0, 1}, infinity}).t, -6, 1e-14);
}

TEST_P(CpuTracer, InstancesShareAGroupAndNumberItsPrimitives) {
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
  const auto tracer = tracer_of(geometry);
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

TEST_P(CpuTracer, AllHitsAreSortedAndComplete) {
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

/// One of every type, stretched and turned, caps where there are any; the same again as an instance that turns them
/// once more.
std::shared_ptr<const Geometry> every_type() {
  GeometryBuilder types;
  for (std::size_t i = 0; i < quadric_type_count; ++i) {
    const auto type = static_cast<QuadricType>(i);
    QuadricShape shape{.type = type};
    shape.capped = type == QuadricType::cylinder || type == QuadricType::cone || type == QuadricType::paraboloid;
    if (type == QuadricType::general) {
      shape.matrix = {1, 0.2, 0, 0, 1.5, 0, 0.1, -1, 0, -0.25};
      shape.box = Box{glm::dvec3(-1, -1, -1), glm::dvec3(1, 1, 1)};
    }
    if (type == QuadricType::plane) continue;  // has no end
    types.add(shape, 0,
              Affine::translate({3 * static_cast<double>(i % 4), 3 * static_cast<double>(i / 4), 0}) *
                  Affine::rotate({1, 2, 3}, 40 * static_cast<double>(i)) * Affine::scale({1, 0.7, 1.2}));
  }
  types.add(QuadricShape{}, 0, Affine::translate({9, 6, 0}));  // no type of its own, but a kind
  const auto group = types.build();
  GeometryBuilder builder;
  for (std::uint32_t i = 0; i < group->objects.size(); ++i) builder.add(*group, i);
  builder.add(group, Affine::translate({0, 0, 5}) * Affine::rotate({1, 1, 0}, 20) * Affine::scale({1, 1.5, 0.8}));
  return builder.build();
}

void expect_normals_of_reference(Tracer& tracer, const std::shared_ptr<const Geometry>& geometry, float slack) {
  const std::vector<Ray> rays = random_rays(geometry->bounds, 10000);
  std::vector<Hit> exact(rays.size()), hits(rays.size());
  make_reference_tracer(geometry)->closest(rays, exact, RayClass::bounce);
  for (const RayClass c : {RayClass::primary, RayClass::bounce}) {
    tracer.closest(rays, hits, c);
    std::size_t compared = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (!exact[i].hit() || hits[i].object != exact[i].object || hits[i].primitive != exact[i].primitive) continue;
      ++compared;
      for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(hits[i].normal[axis], exact[i].normal[axis], slack) << i;
      EXPECT_EQ(hits[i].u, 0);
      EXPECT_EQ(hits[i].v, 0);
    }
    EXPECT_GT(compared, 1000u);
  }
}

TEST_P(CpuTracer, NormalsOfQuadricsAreThoseOfTheReference) {
  const auto geometry = every_type();
  expect_normals_of_reference(*tracer_of(geometry), geometry, 3e-7f);
}

TEST(EmbreeTracer, NormalsOfQuadricsAreGoodEnoughAtFast) {
  const auto geometry = every_type();
  expect_normals_of_reference(*make_embree_tracer(geometry, Precision::fast), geometry, 1e-3f);
}

TEST(EmbreeTracer, AnApexHasNoNormal) {
  GeometryBuilder builder;
  builder.add(QuadricShape{.type = QuadricType::cone, .clip = {{-1, 1}}});
  const auto tracer = make_embree_tracer(builder.build(), Precision::robust);
  for (const RayClass c : {RayClass::primary, RayClass::bounce}) {
    const Hit hit = closest(*tracer, {{0, 0, -2}, 0, {0.5, 0, 2}, infinity}, c);
    ASSERT_TRUE(hit.hit());
    EXPECT_FALSE(std::isnan(hit.normal.x + hit.normal.y + hit.normal.z));
  }
}

std::shared_ptr<const Geometry> crowd() {
  GeometryBuilder builder;
  Random random(7, 0);
  const auto somewhere = [&] {
    return glm::dvec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
  };
  for (int i = 0; i < 200; ++i) {
    const Affine to_world = Affine::translate(somewhere()) * Affine::scale(glm::dvec3(0.1));
    const QuadricType type = i % 3 ? QuadricType::sphere : QuadricType::cylinder;
    builder.add(QuadricShape{.type = type, .capped = i % 2 == 0 && type == QuadricType::cylinder}, 0, to_world);
    const glm::dvec3 at = somewhere();
    builder.add(Mesh{{at, at + 0.2 * somewhere(), at + 0.2 * somewhere()}, {}, {{0, 1, 2}}});
  }
  return builder.build();
}

bool same(const Hit& a, const Hit& b) {
  return a.t == b.t && a.object == b.object && a.primitive == b.primitive && a.u == b.u && a.v == b.v &&
         a.normal == b.normal && a.status == b.status;
}

/// A ray's answer is its own, whoever travels with it: neighbours, strangers or nobody.
TEST(BvhTracer, AnswersDoNotDependOnCompany) {
  const auto geometry = crowd();
  const auto tracer = make_bvh_tracer(geometry, Precision::robust);
  std::vector<Ray> rays = random_rays(geometry->bounds, 3001);
  for (std::size_t i = 1000; i < 2000; ++i) {  // some that keep together
    rays[i] = rays[1000];
    rays[i].origin += 1e-4 * static_cast<double>(i) * glm::dvec3(0.1, 0.2, 0.05);
  }
  std::vector<Hit> together(rays.size());
  std::vector<std::uint32_t> any(rays.size());
  tracer->closest(rays, together, RayClass::primary);
  tracer->any(rays, any, RayClass::shadow);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_TRUE(same(closest(*tracer, rays[i]), together[i])) << i;
    EXPECT_EQ(any[i], together[i].status & status_hit) << i;
    hits += together[i].hit();
  }
  EXPECT_GT(hits, 500u);
}

/// Many triangles about one point, and rays through exactly that point: none gets through.
TEST(BvhTracer, LosesNothingAtAVertex) {
  constexpr int blades = 37;
  Mesh fan{{{0, 0, 0}}, {}, {}};
  for (unsigned i = 0; i < blades; ++i) {
    const double turn = 2 * 3.141592653589793 * i / blades;
    fan.positions.emplace_back(std::cos(turn), std::sin(turn), 0.3 * std::sin(5 * turn));
    fan.triangles.emplace_back(0, 1 + i, 1 + (i + 1) % blades);
  }
  GeometryBuilder builder;
  builder.add(fan, 0, Affine::translate({0.1, 0.7, -0.3}));
  const auto geometry = builder.build();
  const auto tracer = make_bvh_tracer(geometry, Precision::robust);
  const glm::dvec3 vertex = geometry->vertex(0);
  Random random(3, 0);
  for (int i = 0; i < 5000; ++i) {
    // The vertex is reached exactly: components are few bits, t is a power of two.
    const auto coarse = [&] { return std::floor(random.between(-64, 64)) / 64; };
    const glm::dvec3 direction(coarse(), coarse(), 1 + std::abs(coarse()));
    const Hit hit = closest(*tracer, {vertex - 4.0 * direction, 0, direction, infinity}, RayClass::bounce);
    EXPECT_TRUE(hit.hit()) << i;
    EXPECT_NEAR(hit.t, 4, 1e-14);
  }
}

TEST(BvhTracer, TiesGoToTheLowestIds) {
  GeometryBuilder builder;
  for (int i = 0; i < 40; ++i) builder.add(Mesh{{{-1, -1, 2}, {1, -1, 2}, {0, 1, 2}}, {}, {{0, 1, 2}, {0, 1, 2}}});
  const auto tracer = make_bvh_tracer(builder.build(), Precision::robust);
  for (const double y : {-0.9, -0.5, 0.0, 0.5}) {
    const Hit hit = closest(*tracer, {{0, y, 0}, 0, {0, 0, 1}, infinity});
    EXPECT_EQ(hit.object, 0u);
    EXPECT_EQ(hit.primitive, 0u);
    EXPECT_EQ(hit.t, 2);
  }
}

TEST(BvhTracer, IntervalsAreHalfOpen) {
  GeometryBuilder builder;
  builder.add(QuadricShape{});
  const auto tracer = make_bvh_tracer(builder.build(), Precision::robust);
  EXPECT_EQ(closest(*tracer, {{0, 0, -5}, 0, {0, 0, 1}, 4}).t, 4);
  EXPECT_FALSE(closest(*tracer, {{0, 0, -5}, 0, {0, 0, 1}, std::nextafter(4, 0)}).hit());
  EXPECT_EQ(closest(*tracer, {{0, 0, -5}, 4, {0, 0, 1}, infinity}).t, 6);
  EXPECT_EQ(closest(*tracer, {{0, 0, 5}, -6, {0, 0, 1}, -4}).t, -4);
}

}  // namespace
}  // namespace rayengine
