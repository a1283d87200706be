// The grid and the way through it: nothing that a ray hits may be missing from the voxels that it is led through.

#include "accel/grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "accel/kernels/kernels.h"
#include "accel/random.h"
#include "accel/tracer.h"
#include "accel/voxel_overlap.h"
#include "cpu/reference_tracer.h"
#include "engine/measure/rays.h"
#include "gpu/scene/frame_ray.h"

namespace rayengine {
namespace {

using kernels::Vec3;

/// A voxel on a ray's way, and where the ray leaves it.
struct Visit {
  glm::uvec3 voxel;
  float leave;
};

Vec3<float> vec(const glm::vec3& v) { return {v.x, v.y, v.z}; }

/// All voxels from tmin to tmax.
std::vector<Visit> way_through(const Grid& grid, const FrameRay& ray) {
  const Vec3<float> lower = vec(grid.lower), cell = vec(grid.cell), counts = vec(glm::vec3(grid.counts));
  const Vec3<float> o = vec(ray.origin), d = vec(ray.direction);
  Vec3<float> voxel, next;
  bool inside = false;
  kernels::enter_grid<float>(lower, cell, counts, o, d, ray.tmin, ray.tmax, voxel, inside);
  std::vector<Visit> visits;
  for (; inside; voxel = next) {
    float leave;
    kernels::leave_voxel<float>(lower, cell, o, d, voxel, leave, next);
    visits.push_back({{voxel.x, voxel.y, voxel.z}, leave});
    inside = kernels::in_grid<float>(counts, next) && !(ray.tmax < leave - kernels::frame_slack<float>(leave));
  }
  return visits;
}

Grid empty_grid(const glm::vec3& size, const glm::uvec3& counts) {
  Grid grid;
  grid.lower = -0.5f * size, grid.cell = size / glm::vec3(counts), grid.counts = counts;
  return grid;
}

/// How far a point lies outside of a voxel.
double distance(const Grid& grid, const glm::uvec3& voxel, const glm::dvec3& p) {
  const glm::dvec3 lower = glm::dvec3(grid.lower) + glm::dvec3(voxel) * glm::dvec3(grid.cell);
  const glm::dvec3 outside = glm::max(lower - p, p - lower - glm::dvec3(grid.cell));
  return std::max({outside.x, outside.y, outside.z, 0.});
}

/// Coordinates that random numbers never are: on planes, zeros of both signs, nearly zero.
float awkward(Random& random, float size, std::uint32_t count, bool direction) {
  switch (random.below(5)) {
    case 0: return 0.f;
    case 1: return -0.f;
    case 2: return direction ? static_cast<float>(random.between(-1e-30, 1e-30)) : -0.5f * size;
    case 3: return direction ? 1.f : -0.5f * size + size / static_cast<float>(count) * 2;
    default: return static_cast<float>(random.between(-1.9, 1.9));
  }
}

TEST(GridWalk, NeverLeavesTheRay) {
  const Grid grids[] = {empty_grid({2, 2, 2}, {16, 16, 16}), empty_grid({1.7f, 0.3f, 1.1f}, {1000, 7, 33}),
                        empty_grid({2, 2, 2e-5f}, {300, 200, 1})};
  std::size_t inside = 0;
  for (const Grid& grid : grids)
    for (std::uint64_t i = 0; i < 4000; ++i) {
      Random random(7, i);
      FrameRay ray;
      const glm::vec3 size = grid.cell * glm::vec3(grid.counts);
      for (int k = 0; k < 3; ++k) {
        ray.origin[k] = awkward(random, size[k], grid.counts[k], false) * (i % 3 ? 1.f : .3f);
        ray.direction[k] = awkward(random, size[k], grid.counts[k], true);
      }
      if (ray.direction == glm::vec3(0)) ray.direction.y = 1;
      ray.tmin = i % 4 ? 0 : -2, ray.tmax = i % 5 ? 8 : 0.5f;
      const auto visits = way_through(grid, ray);
      std::size_t v = 0;
      for (int k = 0; k <= 400; ++k) {
        const double t = ray.tmin + k / 400. * (static_cast<double>(ray.tmax) - ray.tmin);
        const glm::dvec3 p = glm::dvec3(ray.origin) + t * glm::dvec3(ray.direction);
        const glm::dvec3 reach = 0.5 * glm::dvec3(size) - glm::abs(p);
        if (std::min({reach.x, reach.y, reach.z}) < 0x1p-18) continue;  // nothing lies so near the grid's border
        while (v < visits.size() && visits[v].leave < t) ++v;
        ASSERT_LT(v, visits.size()) << "ray " << i << " is lost at t " << t;
        ASSERT_LT(distance(grid, visits[v].voxel, p), 0x1p-18) << "ray " << i << " at t " << t;
        ++inside;
      }
    }
  EXPECT_GT(inside, 100000u);
}

TEST(GridWalk, IsTheSameForBothZeros) {
  const Grid grid = empty_grid({2, 2, 2}, {8, 8, 8});
  for (const glm::vec3& origin : {glm::vec3(-3, 0, .1f), glm::vec3(-3, .25f, -1), glm::vec3(-.6f, 1, 1)}) {
    const FrameRay plus{origin, 0, {1, 0.f, 0.f}, 9}, minus{origin, 0, {1, -0.f, -0.f}, 9};
    const auto a = way_through(grid, plus), b = way_through(grid, minus);
    ASSERT_EQ(a.size(), origin.x < -1 ? 8u : 7u);
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].voxel, b[i].voxel);
  }
}

TEST(GridWalk, PassesByWhatItDoesNotMeet) {
  const Grid grid = empty_grid({2, 2, 2}, {8, 8, 8});
  EXPECT_TRUE(way_through(grid, {{-3, 1.1f, 0}, 0, {1, 0, 0}, 9}).empty());
  EXPECT_TRUE(way_through(grid, {{-3, 0, 0}, 0, {1, 0, 0}, 1.9f}).empty());
  EXPECT_TRUE(way_through(grid, {{-3, 0, 0}, 4.1f, {1, 0, 0}, 9}).empty());
  EXPECT_EQ(way_through(grid, {{-3, .1f, .1f}, 0, {1, 0, 0}, 2.3f}).size(), 2u);
}

bool lists(const Grid& grid, const Treelet& list, const Geometry& geometry, const Hit& hit) {
  const Object& object = geometry.objects[hit.object];
  const bool mesh = object.kind == Object::Kind::mesh;
  const auto& ids = mesh ? grid.lists.triangles : grid.lists.quadrics;
  const auto first = ids.begin() + (mesh ? list.first_triangle : list.first_quadric);
  const auto last = first + (mesh ? list.triangle_count : list.quadric_count);
  return std::find(first, last, object.first + (mesh ? hit.primitive : 0)) != last;
}

/// Whether a voxel on the ray's way to the hit lists what was hit.
bool meets(const Grid& grid, const Geometry& geometry, const FrameRay& ray, const Hit& hit) {
  if (lists(grid, grid.lists.unbounded, geometry, hit)) return true;
  for (const Visit& v : way_through(grid, ray)) {
    const std::uint32_t list = grid.voxels[(v.voxel.z * grid.counts.y + v.voxel.y) * grid.counts.x + v.voxel.x];
    if (list != no_id && lists(grid, grid.lists.treelets[list], geometry, hit)) return true;
    if (ray.to_frame(hit.t) < v.leave - kernels::frame_slack(v.leave)) return false;
  }
  return false;
}

/// Every hit that the oracle finds, along random rays and rays aimed at edges.
void expect_nothing_lost(const std::shared_ptr<const Geometry>& geometry, const GridOptions& options = {}) {
  const Grid grid = build_grid(*geometry, options);
  auto rays = random_rays(geometry->bounds, 400);
  for (const Ray& ray : aimed_rays(*geometry, 400)) rays.push_back(ray);
  const HitLists all = make_reference_tracer(geometry)->all(rays);
  ASSERT_GT(all.hits.size(), 100u);
  for (std::size_t i = 0; i < rays.size(); ++i)
    for (auto k = all.offsets[i]; k < all.offsets[i + 1]; ++k)
      ASSERT_TRUE(meets(grid, *geometry, in_frame(grid.lists.frame, rays[i]), all.hits[k]))
          << "ray " << i << " misses object " << all.hits[k].object << " part " << all.hits[k].primitive;
}

Mesh sheet(unsigned n, double height) {
  Mesh mesh;
  for (unsigned y = 0; y <= n; ++y)
    for (unsigned x = 0; x <= n; ++x) mesh.positions.emplace_back(x, y, height * std::sin(x + 0.3 * y));
  for (unsigned y = 0; y < n; ++y)
    for (unsigned x = 0; x < n; ++x) {
      const unsigned i = y * (n + 1) + x;
      mesh.triangles.emplace_back(i, i + 1, i + n + 1);
      mesh.triangles.emplace_back(i + 1, i + n + 2, i + n + 1);
    }
  return mesh;
}

std::shared_ptr<const Geometry> every_quadric(bool capped, const glm::dvec3& place, double size) {
  GeometryBuilder builder;
  for (int i = 0; i < 27; ++i) {
    QuadricShape shape;
    shape.type = static_cast<QuadricType>(i % 9);
    shape.capped = capped && shape.type != QuadricType::plane && shape.type != QuadricType::disk &&
                   shape.type != QuadricType::sphere && shape.type != QuadricType::saddle;
    builder.add(shape, 0,
                Affine::translate(place) * Affine::scale(glm::dvec3(size)) *
                    Affine::translate({3 * std::cos(i), 3 * std::sin(2. * i), .1 * i}) *
                    Affine::rotate({1, i, 2}, 40 * i) * Affine::scale({1 + .1 * (i % 5), .3, 1 - .1 * (i % 3)}));
  }
  return builder.build();
}

TEST(Grid, LosesNoTriangle) {
  GeometryBuilder builder;
  builder.add(sheet(24, 1));
  builder.add(sheet(3, .5), 0, Affine::rotate({1, 2, 3}, 50) * Affine::scale({6, 5, 4}));
  expect_nothing_lost(builder.build());
}

TEST(Grid, LosesNothingOfAFlatScene) {
  GeometryBuilder builder;
  builder.add(sheet(24, 0));
  const auto geometry = builder.build();
  const Grid grid = build_grid(*geometry);
  EXPECT_EQ(grid.counts.z, 1u);
  EXPECT_GT(grid.counts.x, 20u);
  expect_nothing_lost(geometry);
}

TEST(Grid, LosesNoQuadric) {
  for (const bool capped : {false, true}) expect_nothing_lost(every_quadric(capped, {0, 0, 0}, 1), {.density = 100});
}

TEST(Grid, LosesNothingFarAway) {
  expect_nothing_lost(every_quadric(true, {1e6, -1e6, 1e5}, 1), {.density = 100});
  expect_nothing_lost(every_quadric(true, {0, 0, 0}, 1e-9), {.density = 100});
}

TEST(Grid, LeavesOutTheInsideOfASphere) {
  GeometryBuilder builder;
  builder.add(QuadricShape{});
  const Grid grid = build_grid(*builder.build(), {.density = 8000});
  const auto empty = std::count(grid.voxels.begin(), grid.voxels.end(), no_id);
  EXPECT_EQ(grid.counts, glm::uvec3(20));
  EXPECT_GT(empty, 8000 * 0.7);  // a shell of a voxel or two: 1 - 4 pi 10^2 * 1.8 / 8000
  EXPECT_LT(empty, 8000 * 0.9);
}

TEST(Grid, HoldsNothingAtAll) {
  const Grid grid = build_grid(*GeometryBuilder().build());
  EXPECT_EQ(grid.voxels, std::vector<std::uint32_t>{no_id});
  GeometryBuilder builder;
  builder.add(QuadricShape{QuadricType::plane, false, {}, {}, {}});
  EXPECT_EQ(build_grid(*builder.build()).lists.unbounded.quadric_count, 1u);
}

TEST(Grid, RefusesListsThatAreTooLong) {
  GeometryBuilder builder;
  builder.add(sheet(24, 1));
  try {
    build_grid(*builder.build(), {.most_members = 2000});
    FAIL() << "nothing was refused";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("2000"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("--tracer stream"), std::string::npos) << e.what();
  }
}

TEST(GridCounts, AreNearCubesAndOneWhereItIsThin) {
  const auto counts = [](const glm::dvec3& size, std::size_t n) { return grid_counts(size, n, {.density = 4}); };
  EXPECT_EQ(counts({1, 1, 1}, 250), glm::uvec3(10));
  EXPECT_EQ(counts({2, 1, 1}, 500), glm::uvec3(20, 10, 10));
  EXPECT_EQ(counts({1, 1, 0}, 100), glm::uvec3(20, 20, 1));
  EXPECT_EQ(counts({1, 0, 0}, 25), glm::uvec3(100, 1, 1));
  EXPECT_EQ(counts({0, 0, 0}, 25), glm::uvec3(1));
  EXPECT_EQ(counts({1, 0, 0}, 1000), glm::uvec3(1024, 1, 1));
}

TEST(VoxelOverlap, TellsTrianglesApart) {
  const Voxel unit{{0, 0, 0}, {1, 1, 1}};
  const auto overlap = [&](glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) { return overlaps({a, b, c}, unit); };
  EXPECT_TRUE(overlap({-.1, 0, 0}, {.1, 0, 0}, {0, .1, 0})) << "inside";
  EXPECT_TRUE(overlap({-9, -9, .5}, {9, -9, .5}, {0, 9, .5})) << "through";
  EXPECT_TRUE(overlap({2.9, 0, 0}, {0, 2.9, 0}, {0, 0, 2.9})) << "cuts a corner";
  EXPECT_FALSE(overlap({3.1, 0, 0}, {0, 3.1, 0}, {0, 0, 3.1})) << "passes that corner";
  EXPECT_TRUE(overlap({1.9, 0, -9}, {0, 1.9, -9}, {.95, .95, 9})) << "cuts an edge";
  EXPECT_FALSE(overlap({2.1, 0, 0}, {0, 2.1, 0}, {2.1, 2.1, 0})) << "passes that edge";
  EXPECT_TRUE(overlap({0, 0, 0}, {0, 0, 0}, {5, 5, 5})) << "is a line";
}

}  // namespace
}  // namespace rayengine
