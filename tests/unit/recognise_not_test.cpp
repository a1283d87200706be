#include <gtest/gtest.h>

#include <cmath>

#include "accel/random.h"
#include "engine/measure/stress/shapes.h"
#include "engine/plan/recognise/recognise.h"
#include "recognise_meshes.h"

namespace rayengine {
namespace {

using namespace test;

void expect_untouched(const Mesh& mesh, double tolerance) {
  const Recognition found = recognise(mesh, tolerance);
  EXPECT_TRUE(found.quadrics.empty());
  EXPECT_EQ(found.rest.size(), mesh.triangles.size());
}

TEST(RecogniseNot, ASphereWithAHole) {
  for (const std::size_t hole : {1, 4, 200}) {
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
  Mesh mixed = one;
  append(mixed, soup(one));
  expect_untouched(mixed, 0.05);
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

TEST(RecogniseNot, TubesWithAHole) {
  for (const stability::Body& body : stability::bodies()) {
    if (body.shape.type == QuadricType::sphere || body.shape.type == QuadricType::general || body.shape.capped)
      continue;
    Mesh mesh = tessellated(body.shape, 3);
    if (body.shape.type == QuadricType::hyperboloid2) mesh.triangles.resize(mesh.triangles.size() / 2);
    const std::size_t hole = mesh.triangles.size() / 2 + 3;
    mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(hole));
    const Recognition found = recognise(mesh, 0.03);
    EXPECT_GT(found.rest.size(), 5u) << body.name;  // parts beside the hole may be whole sectors
    expect_kept(mesh, found, 0.03);
  }
}

TEST(RecogniseNot, ATubeWithASlantedEnd) {
  Mesh mesh = tessellated({.type = QuadricType::cylinder}, 3);
  for (glm::dvec3& p : mesh.positions)
    if (p.z == 1) p.z += 0.2 * p.x;
  expect_untouched(mesh, 0.05);
}

TEST(RecogniseNot, PlatesWithOtherOutlines) {
  Mesh mesh = grid(6, 6, [](double u, double v) { return glm::dvec3(u, v, 0); });
  mesh.triangles.erase(mesh.triangles.begin() + 30, mesh.triangles.begin() + 32);  // a hole
  expect_untouched(mesh, 0.01);
  expect_untouched(grid(6, 6, [](double u, double v) { return glm::dvec3(u + 0.3 * v, v, 0); }), 0.01);
}

TEST(RecogniseNot, Waves) { expect_untouched(waves(40), 0.002); }

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

}  // namespace
}  // namespace rayengine
