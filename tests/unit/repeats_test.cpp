#include "engine/plan/repeats.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "accel/tracer.h"
#include "engine/measure/tessellate.h"
#include "engine/tracers.h"

namespace rayengine {
namespace {

constexpr std::uint32_t any_size = 1;

/// A sphere with a bump, so that no rotation takes it to itself; of few bits, which translations need not round.
Mesh pear() {
  Mesh mesh = subdivided_sphere(3);
  for (glm::dvec3& p : mesh.positions)
    p = glm::round(0x1p20 * p * (1 + 0.3 * p.x * p.x * p.x + 0.1 * p.y + 0.05 * p.z)) * 0x1p-20;
  return mesh;
}

Mesh with_normals(Mesh mesh) {
  for (const glm::dvec3& p : mesh.positions) mesh.normals.push_back(glm::vec3(glm::normalize(p)));
  return mesh;
}

Affine motion() {
  return Affine::translate({3, -2, 5}) * Affine::rotate({1, 2, 3}, 40) * Affine::scale(glm::dvec3(2.5));
}

Mesh moved(Mesh mesh, const Affine& map) {
  for (glm::dvec3& p : mesh.positions) p = map.point(p);
  return mesh;
}

std::shared_ptr<const Geometry> geometry_of(const std::vector<Mesh>& meshes) {
  GeometryBuilder builder;
  for (const Mesh& mesh : meshes) builder.add(mesh);
  return builder.build();
}

std::vector<Repeat> repeats_of(const std::vector<Mesh>& meshes, double tolerance) {
  return find_repeats(*geometry_of(meshes), tolerance, any_size);
}

TEST(Repeats, FindsTranslationsBitForBit) {
  const Mesh mesh = pear();
  const std::vector<Mesh> meshes{mesh, moved(mesh, Affine::translate({64, 0, -8})), subdivided_sphere(3),
                                 moved(mesh, Affine::translate({-16, 4, 0}))};
  for (const double tolerance : {0., 1e-3}) {
    const auto repeats = repeats_of(meshes, tolerance);
    ASSERT_EQ(repeats.size(), 2u);
    const std::uint32_t objects[] = {1, 3};
    for (int i = 0; i < 2; ++i) {
      EXPECT_EQ(repeats[i].first, 0u);
      EXPECT_EQ(repeats[i].object, objects[i]);
      EXPECT_EQ(repeats[i].error, 0);
      for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        EXPECT_EQ(repeats[i].from_first.point(mesh.positions[v]), meshes[objects[i]].positions[v]);
    }
  }
}

TEST(Repeats, TellsALastBitFromNone) {
  const Mesh mesh = pear();
  Mesh other = moved(mesh, Affine::translate({4, 0, 0}));
  other.positions[99].y = std::nextafter(other.positions[99].y, 9);
  EXPECT_TRUE(repeats_of({mesh, other}, 0).empty());
  const auto near = repeats_of({mesh, other}, 1e-6);
  ASSERT_EQ(near.size(), 1u);
  EXPECT_GT(near[0].error, 0);
  EXPECT_LE(near[0].error, 1e-6);
}

TEST(Repeats, TakesNoTranslationThatRounds) {
  const Mesh mesh = pear();
  EXPECT_TRUE(repeats_of({mesh, moved(mesh, Affine::translate({0.1, 0, 0}))}, 0).empty());
  EXPECT_TRUE(repeats_of({mesh, moved(mesh, Affine::translate({1e12, 0, 0}))}, 0).empty());  // steps of 1/8192
  EXPECT_EQ(repeats_of({mesh, moved(mesh, Affine::translate({1e12, 0, 0}))}, 1e-3).size(), 1u);
}

TEST(Repeats, FindsRigidMotionsWithinATolerance) {
  const Mesh mesh = with_normals(pear());
  GeometryBuilder builder;
  builder.add(mesh);
  builder.add(mesh, 0, motion());
  const auto geometry = builder.build();
  EXPECT_TRUE(find_repeats(*geometry, 0, any_size).empty());
  const auto repeats = find_repeats(*geometry, 1e-5, any_size);
  ASSERT_EQ(repeats.size(), 1u);
  for (const glm::dvec3& p : mesh.positions) {
    const double off = glm::length(repeats[0].from_first.point(p) - motion().point(p));
    EXPECT_LE(off, repeats[0].error);
    EXPECT_LE(off, 1e-5);
  }
}

TEST(Repeats, HoldsEveryVertexToTheTolerance) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> noise(-1, 1);
  for (const double amount : {0.003, 0.03}) {
    Mesh other = moved(pear(), motion());
    for (glm::dvec3& p : other.positions) p += amount * glm::dvec3(noise(random), noise(random), noise(random));
    const auto repeats = repeats_of({pear(), other}, 0.02);
    EXPECT_EQ(repeats.size(), amount < 0.02 ? 1u : 0u) << amount;
    for (const Repeat& r : repeats) EXPECT_LE(r.error, 0.02);
  }
}

TEST(Repeats, TakesNoMirrorImages) {
  EXPECT_TRUE(repeats_of({pear(), moved(pear(), Affine::scale({-1, 1, 1}))}, 1e-3).empty());
}

TEST(Repeats, TakesNoStretchedCopies) {
  EXPECT_TRUE(repeats_of({pear(), moved(pear(), Affine::scale({1, 1, 1.1}))}, 1e-3).empty());
}

TEST(Repeats, TellsTrianglesAndTheirOrderApart) {
  const Mesh mesh = pear();
  Mesh flipped = mesh, fewer = mesh, reordered = mesh;
  std::swap(flipped.triangles[5].x, flipped.triangles[5].y);
  fewer.triangles.pop_back();
  std::swap(reordered.triangles[0], reordered.triangles[1]);
  for (const double tolerance : {0., 1.}) EXPECT_TRUE(repeats_of({mesh, flipped, fewer, reordered}, tolerance).empty());
}

TEST(Repeats, TellsNormalsApart) {
  const Mesh mesh = with_normals(pear());
  Mesh turned = mesh;
  turned.normals[7] = -turned.normals[7];
  for (const double tolerance : {0., 1e-3}) {
    EXPECT_EQ(repeats_of({mesh, mesh}, tolerance).size(), 1u);
    EXPECT_TRUE(repeats_of({mesh, turned}, tolerance).empty());
    EXPECT_TRUE(repeats_of({mesh, pear()}, tolerance).empty());
  }
}

TEST(Repeats, TellsMaterialsApart) {
  GeometryBuilder builder;
  for (const std::uint32_t material : {0u, 1u, 0u}) builder.add(pear(), material);
  const auto repeats = find_repeats(*builder.build(), 0);
  ASSERT_EQ(repeats.size(), 1u);
  EXPECT_EQ(repeats[0].object, 2u);
}

TEST(Repeats, LeavesSmallMeshesQuadricsAndInstances) {
  GeometryBuilder inner;
  inner.add(pear());
  const auto group = inner.build();
  GeometryBuilder builder;
  for (int i = 0; i < 3; ++i) {
    builder.add(subdivided_sphere(1));  // 32 triangles
    builder.add(QuadricShape{QuadricType::sphere, false, {}, {}, {}});
    builder.add(group);
    builder.add(Mesh{});
  }
  EXPECT_TRUE(find_repeats(*builder.build(), 0).empty());
}

TEST(Repeats, TakesFlatAndPointLikeMeshes) {
  const Mesh flat{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 1, 2}}};
  const Mesh line{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {}, {{0, 1, 2}}};
  const Mesh point{{{1, 1, 1}}, {}, {{0, 0, 0}}};
  EXPECT_EQ(repeats_of({flat, moved(flat, motion())}, 1e-5).size(), 1u);
  for (const Mesh& mesh : {line, point}) {
    EXPECT_EQ(repeats_of({mesh, moved(mesh, Affine::translate({1, 0, 0}))}, 1e-5).size(), 1u);
    EXPECT_LE(repeats_of({mesh, moved(mesh, motion())}, 1e-5).size(), 1u);
  }
}

TEST(Repeats, RefusesTolerancesThatAreNone) {
  for (const double none : {-1., std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(repeats_of({pear()}, none), Error);
}

TEST(Repeats,
     TakeTimeThatGrowsWithTheMeshesOnly) {  // 4,000 shapes of the same triangles: each with each would take minutes
  std::vector<Mesh> meshes;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> noise(0.5, 1);
  for (int i = 0; i < 4000; ++i) {
    meshes.push_back(subdivided_sphere(2));
    for (glm::dvec3& p : meshes.back().positions) p *= noise(random);
  }
  EXPECT_TRUE(repeats_of(meshes, 1e-3).empty());
  meshes.push_back(moved(meshes[3000], Affine::translate({0, 0, 0})));
  EXPECT_EQ(repeats_of(meshes, 0).size(), 1u);
}

/// What repeats are for: the same hits, with the same ids, from instances.
TEST(Repeats, PlacedAsInstancesAreHitAlike) {
  const Mesh mesh = pear();
  std::vector<Mesh> meshes;
  for (int i = 0; i < 5; ++i) meshes.push_back(moved(mesh, Affine::translate({4.0 * i, 0, 0})));
  const auto plain = geometry_of(meshes);
  const auto repeats = find_repeats(*plain, 0);
  ASSERT_EQ(repeats.size(), 4u);
  const auto group = geometry_of({mesh});
  GeometryBuilder builder;
  builder.add(group);
  for (const Repeat& r : repeats) builder.add(group, r.from_first);
  const auto placed = builder.build();
  std::vector<Ray> rays;
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 20000; ++i)
    rays.push_back(
        {{8 + 10 * unit(random), 1.5 * unit(random), -6}, 0, {0.2 * unit(random), 0.2 * unit(random), 1}, infinity});
  std::vector<Hit> a(rays.size()), b(rays.size());
  make_tracer("reference", plain)->closest(rays, a, RayClass::primary);
  make_tracer("reference", placed)->closest(rays, b, RayClass::primary);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    hits += a[i].object != no_id;
    EXPECT_EQ(a[i].t, b[i].t);
    EXPECT_EQ(a[i].object, b[i].object);
    EXPECT_EQ(a[i].primitive, b[i].primitive);
  }
  EXPECT_GT(hits, rays.size() / 8);
}

}  // namespace
}  // namespace rayengine
