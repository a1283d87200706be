// The grid tracer's ways of doing the same: one answer from all of them.

#include <gtest/gtest.h>

#include "cpu/reference_tracer.h"
#include "engine/measure/rays.h"
#include "gpu/grid/grid_tracer.h"

namespace rayengine {
namespace {

/// All kinds of lists: of triangles, of quadrics of two types, and of what has no bounds.
std::shared_ptr<const Geometry> mixed() {
  GeometryBuilder builder;
  for (int i = 0; i < 60; ++i) {
    const auto type = i % 2 ? QuadricType::sphere : QuadricType::cylinder;
    builder.add(QuadricShape{type, i % 4 == 0, {}, {}, {}}, 0,
                Affine::translate({i % 8 * 1.2, i / 8 * 1.3, .1 * i}) * Affine::scale(glm::dvec3(.7)));
  }
  builder.add(Mesh{{{-3, -3, 2}, {9, -3, 2}, {9, 9, 3}, {-3, 9, 1}}, {}, {{0, 1, 2}, {0, 2, 3}}});
  builder.add(QuadricShape{QuadricType::plane, false, {}, {}, {}}, 0, Affine::translate({0, 0, -1}));
  return builder.build();
}

struct Replies {
  std::vector<Hit> hits;
  std::vector<std::uint32_t> status;
};

Replies ask(Tracer& tracer, std::span<const Ray> rays) {
  Replies a{std::vector<Hit>(rays.size()), std::vector<std::uint32_t>(rays.size())};
  tracer.closest(rays, a.hits, RayClass::primary);
  tracer.any(rays, a.status, RayClass::shadow);
  return a;
}

std::vector<Ray> rays_through(const Geometry& geometry) {
  auto rays = random_rays(geometry.bounds, 3000);
  for (std::size_t i = 0; i < rays.size(); i += 3) rays[i].tmax = 2;
  rays[7].direction = {0, 0, 0};  // invalid
  return rays;
}

void expect_the_same(const GridTracerOptions& options) {
  const auto geometry = mixed();
  const auto rays = rays_through(*geometry);
  const auto usual = make_grid_tracer(geometry, Precision::robust, {.policy = GridPolicy{}});
  const auto other = make_grid_tracer(geometry, Precision::robust, options);
  const Replies a = ask(*usual, rays), b = ask(*other, rays);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_EQ(a.hits[i].t, b.hits[i].t) << "ray " << i;
    ASSERT_EQ(a.hits[i].object, b.hits[i].object) << "ray " << i;
    ASSERT_EQ(a.hits[i].primitive, b.hits[i].primitive) << "ray " << i;
    ASSERT_EQ(a.status[i], b.status[i]) << "ray " << i;
    ASSERT_EQ(a.status[i], a.hits[i].status) << "ray " << i;
    hits += a.hits[i].hit();
  }
  EXPECT_GT(hits, rays.size() / 3);
}

TEST(Grid, OnePassGivesTheAnswersOfMany) { expect_the_same({.policy = GridPolicy{.few = 1}}); }

TEST(Grid, PoliciesGiveTheSameAnswers) {
  expect_the_same({.policy = GridPolicy{.rule = GridPolicy::Rule::share, .share = 0, .steps = 1}});
  expect_the_same({.policy = GridPolicy{.rule = GridPolicy::Rule::share, .share = 1, .steps = 3}});
  expect_the_same({.policy = GridPolicy{.rule = GridPolicy::Rule::most, .steps = 2}});
}

TEST(Grid, PassesAloneGiveTheAnswersOfPassesAndALoop) {
  expect_the_same({});
  expect_the_same({.policy = GridPolicy{.few = 0.5}});
  expect_the_same({.policy = GridPolicy{.steps = 2, .few = 0.2}, .batch_side = 64});
}

TEST(Grid, ResolutionsAndBatchesGiveTheSameAnswers) {
  expect_the_same({.grid = {.density = 0.01}});
  expect_the_same({.grid = {.density = 500}, .batch_side = 16});
}

TEST(Grid, HoldsNothing) {
  const auto tracer = make_grid_tracer(GeometryBuilder().build(), Precision::robust);
  Hit hit;
  const Ray ray;
  tracer->closest({&ray, 1}, {&hit, 1}, RayClass::primary);
  EXPECT_FALSE(hit.hit());
}

TEST(Grid, RefusesAVoxelThatListsTooMuch) {
  Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 1}}, {}, {}};
  mesh.triangles.assign(40000, {0, 1, 2});
  GeometryBuilder builder;
  builder.add(mesh);
  const auto geometry = builder.build();
  try {
    make_grid_tracer(geometry, Precision::robust);
    FAIL() << "nothing was refused";
  } catch (const Error& e) {
    EXPECT_EQ(std::string(e.what()),
              "a voxel of the grid lists 40000 primitives, more than 32768, what a shader can test in one loop; use "
              "--tracer stream");
  }
}

}  // namespace
}  // namespace rayengine
