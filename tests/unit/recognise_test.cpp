#include "engine/plan/recognise/recognise.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "accel/tracer.h"
#include "engine/measure/random.h"
#include "engine/measure/stress/shapes.h"
#include "engine/measure/tessellate.h"
#include "recognised_distance.h"

namespace rayengine {
namespace {

using stability::mapped;

/// One mesh after the other in one.
void append(Mesh& mesh, const Mesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const glm::uvec3& t : other.triangles) mesh.triangles.push_back(t + first);
}

/// Every triangle with corners of its own, as STL files have them.
Mesh soup(const Mesh& mesh) {
  Mesh result;
  for (const glm::uvec3& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(result.positions.size());
    for (int k = 0; k < 3; ++k) result.positions.push_back(mesh.positions[t[k]]);
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

Mesh flipped(Mesh mesh) {
  for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
  return mesh;
}

Mesh sphere(double radius, const glm::dvec3& center, int subdivisions = 3) {
  return mapped(subdivided_sphere(subdivisions), {glm::dmat3(radius), center});
}

/// How far the flattest point of any triangle is within the unit sphere.
double sagitta(const Mesh& unit_sphere) {
  double most = 0;
  for (const glm::uvec3& t : unit_sphere.triangles) {
    const glm::dvec3 &a = unit_sphere.positions[t.x], &b = unit_sphere.positions[t.y], &c = unit_sphere.positions[t.z];
    most = std::max(most, 1 - glm::dot(a, glm::normalize(glm::cross(b - a, c - a))));
  }
  return most;
}

/// The promise, and that every triangle is accounted for once.
void expect_kept(const Mesh& mesh, const Recognition& found, double tolerance, std::size_t samples = 400) {
  std::vector<int> seen(mesh.triangles.size(), 0);
  for (const std::uint32_t t : found.rest) ++seen[t];
  for (const RecognisedQuadric& q : found.quadrics) {
    for (const std::uint32_t t : q.triangles) ++seen[t];
    EXPECT_TRUE(std::ranges::is_sorted(q.triangles));
    EXPECT_GE(q.triangles.size(), fewest_triangles);
    EXPECT_LE(q.residual, tolerance);
    const test::Distances d = test::measured(mesh, q, samples);
    EXPECT_GT(d.points, samples / 50);
    EXPECT_LE(d.to_quadric, q.residual * (1 + 1e-9));
    EXPECT_LE(d.to_mesh, q.residual * (1 + 1e-9));
  }
  EXPECT_TRUE(std::ranges::all_of(seen, [](int n) { return n == 1; }));
  EXPECT_TRUE(std::ranges::is_sorted(found.rest));
}

TEST(Recognise, FindsASphereWithItsCentreAndRadius) {
  const Mesh mesh = sphere(0.3, {5, -2, 0.1});
  const Recognition found = recognise(mesh, 0.01);
  ASSERT_EQ(found.quadrics.size(), 1u);
  EXPECT_EQ(found.quadrics[0].shape.type, QuadricType::sphere);
  EXPECT_EQ(found.quadrics[0].to_world.linear, glm::dmat3(0.3));
  EXPECT_EQ(found.quadrics[0].to_world.origin, glm::dvec3(5, -2, 0.1));
  EXPECT_TRUE(found.rest.empty());
  expect_kept(mesh, found, 0.01);
}

TEST(Recognise, TakesASphereFromItsSagittaOnAndNotBefore) {
  for (const int level : {1, 2, 3}) {
    const Mesh mesh = sphere(2, {1, 2, 3}, level);
    const double deep = 2 * sagitta(subdivided_sphere(level));
    EXPECT_EQ(recognise(mesh, 0.999 * deep).rest.size(), mesh.triangles.size());
    const Recognition found = recognise(mesh, 1.001 * deep);
    ASSERT_EQ(found.quadrics.size(), 1u);
    EXPECT_NEAR(found.quadrics[0].residual, deep, 1e-12);
    expect_kept(mesh, found, 1.001 * deep);
  }
}

TEST(Recognise, FindsSpheresOfTrianglesWithoutCommonVertices) {
  Mesh mesh = soup(sphere(1, {0, 0, 0}));
  append(mesh, soup(sphere(0.5, {1.5, 0, 0})));
  const Recognition found = recognise(mesh, 0.05);
  EXPECT_EQ(found.quadrics.size(), 2u);
  expect_kept(mesh, found, 0.05);
}

TEST(Recognise, FindsManySpheresInOneMeshWhateverTheNumberOfThreads) {
  Mesh mesh;
  Random random(1, 1);
  for (int i = 0; i < 200; ++i)
    append(mesh, sphere(random.between(0.5, 1), 20. * glm::dvec3(random.unit(), random.unit(), random.unit()), 2));
  const Recognition found = recognise(mesh, 0.1);
  EXPECT_EQ(found.quadrics.size(), 200u);
  EXPECT_TRUE(found.rest.empty());
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Recognition again = recognise(mesh, 0.1);
  ASSERT_EQ(again.quadrics.size(), found.quadrics.size());
  for (std::size_t i = 0; i < found.quadrics.size(); ++i) {
    EXPECT_EQ(again.quadrics[i].to_world.origin, found.quadrics[i].to_world.origin);
    EXPECT_EQ(again.quadrics[i].triangles, found.quadrics[i].triangles);
    EXPECT_EQ(again.quadrics[i].residual, found.quadrics[i].residual);
  }
}

TEST(Recognise, KeepsItsPromiseOnSpheresWithNoise) {
  for (int i = 0; i < 40; ++i) {
    Random random(2, i);
    Mesh mesh = sphere(1, {random.between(-9, 9), 0, 0}, 2);
    const double noise = std::pow(10., random.between(-6, -1));
    for (glm::dvec3& p : mesh.positions) p += noise * random.direction();
    const double tolerance = random.between(0.02, 0.2);
    expect_kept(mesh, recognise(mesh, tolerance), tolerance);
  }
}

// ---- What must stay triangles.

void expect_untouched(const Mesh& mesh, double tolerance) {
  const Recognition found = recognise(mesh, tolerance);
  EXPECT_TRUE(found.quadrics.empty());
  EXPECT_EQ(found.rest.size(), mesh.triangles.size());
}

TEST(RecogniseNot, ASphereWithAHole) {
  for (const std::size_t hole : {1, 4, 256}) {
    Mesh mesh = sphere(1, {0, 0, 0});
    mesh.triangles.resize(512 - hole);
    expect_untouched(mesh, 0.05);
  }
}

TEST(RecogniseNot, ASphereInsideOut) { expect_untouched(flipped(sphere(1, {0, 0, 0})), 0.05); }

TEST(RecogniseNot, ASphereWithOneTriangleFlipped) {
  Mesh mesh = sphere(1, {0, 0, 0});
  std::swap(mesh.triangles[77].x, mesh.triangles[77].y);
  expect_untouched(mesh, 0.05);
  expect_untouched(soup(mesh), 0.05);
}

TEST(RecogniseNot, ADoubledShell) {
  const Mesh one = sphere(1, {0, 0, 0});
  for (const Mesh& other : {one, flipped(one), sphere(1.001, {0, 0, 0}), flipped(sphere(0.999, {0, 0, 0}))}) {
    Mesh mesh = one;
    append(mesh, other);
    expect_untouched(mesh, 0.05);
    expect_untouched(soup(mesh), 0.05);
  }
  Mesh same = one;  // twice over the same vertices
  same.triangles.insert(same.triangles.end(), one.triangles.begin(), one.triangles.end());
  expect_untouched(same, 0.05);
}

TEST(RecogniseNot, ASphereThatIsCoveredTwiceByOnePiece) {
  // Two shells, cut open along one edge each and sewn to each other there: closed, and everywhere facing outward.
  Mesh mesh = sphere(1, {0, 0, 0});
  const std::uint32_t count = static_cast<std::uint32_t>(mesh.positions.size());
  append(mesh, Mesh(mesh));
  const glm::uvec3 t = mesh.triangles[100];
  for (std::size_t i = 512; i < 1024; ++i)
    for (int k = 0; k < 3; ++k)  // both share an edge's vertices, so that four triangles meet there
      for (const std::uint32_t v : {t.x, t.y})
        if (mesh.triangles[i][k] == v + count) mesh.triangles[i][k] = v;
  expect_untouched(mesh, 0.05);
}

TEST(RecogniseNot, ASphereWithNoiseNearTheTolerance) {
  Mesh mesh = sphere(1, {0, 0, 0});
  Random random(3, 3);
  for (glm::dvec3& p : mesh.positions) p *= 1 + random.between(-0.04, 0.04);
  expect_untouched(mesh, 0.05);
}

TEST(RecogniseNot, FewTriangles) {
  expect_untouched(stability::bipyramid(3, 1, 1), 10);
  expect_untouched(Mesh{}, 1);
}

TEST(RecogniseNot, DegenerateTriangles) {
  Mesh mesh;
  mesh.positions.assign(30, glm::dvec3(1, 2, 3));
  for (std::uint32_t i = 0; i < 30; ++i) mesh.triangles.push_back({i, (i + 1) % 30, (i + 7) % 30});
  expect_untouched(mesh, 1);
  for (std::uint32_t i = 0; i < 30; ++i) mesh.positions[i] = {i, 0, 0};
  expect_untouched(mesh, 1);
  for (std::uint32_t i = 0; i < 30; ++i) mesh.triangles[i] = {i, i, i};
  expect_untouched(mesh, 1);
}

TEST(Recognise, KeepsItsPromiseAtAnyScaleAndDistance) {
  for (const double radius : {1e-120, 1e-30, 1e-6, 1., 1e6, 1e30, 1e120})
    for (const double away : {0., 1., 1e6, 1e12}) {
      const Mesh mesh = sphere(radius, radius * away * glm::dvec3(1, 0.3, -0.7), 2);
      const Recognition found = recognise(mesh, 0.1 * radius);
      expect_kept(mesh, found, 0.1 * radius);
      const bool within_reach = away <= 1e6 && radius > 1e-100 && radius < 1e100;
      EXPECT_TRUE(!within_reach || found.quadrics.size() == 1) << radius << " " << away;
    }
  const Mesh mesh = sphere(1e-6, {1e6, 1e6, 0}, 2);
  expect_kept(mesh, recognise(mesh, 1e-7), 1e-7);
}

TEST(Recognise, RefusesTolerancesThatCannotBeKeptAndMeshesThatAreNone) {
  const Mesh mesh = sphere(1, {0, 0, 0}, 1);
  for (const double tolerance : {0., -1., std::nan(""), infinity}) EXPECT_THROW(recognise(mesh, tolerance), Error);
  Mesh wrong = mesh;
  wrong.triangles[3].y = 10000;
  EXPECT_THROW(recognise(wrong, 1), Error);
  wrong = mesh;
  wrong.positions[3].y = std::nan("");
  EXPECT_THROW(recognise(wrong, 1), Error);
}

}  // namespace
}  // namespace rayengine
