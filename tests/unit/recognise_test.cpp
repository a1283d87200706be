#include "engine/plan/recognise/recognise.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "accel/tracer.h"
#include "accel/random.h"
#include "engine/measure/stress/shapes.h"
#include "engine/measure/tessellate.h"
#include "engine/tracers.h"
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
    EXPECT_GT(d.points, 0u) << to_string(q.shape.type) << " of " << q.triangles.size();
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

// ---- Every type of quadric.

Mesh mesh_of(const Geometry& geometry) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < geometry.vertices.size(); ++i) mesh.positions.push_back(geometry.vertex(i));
  mesh.triangles = geometry.triangles;
  return mesh;
}

class RecogniseBody : public testing::TestWithParam<stability::Body> {};
INSTANTIATE_TEST_SUITE_P(Bodies, RecogniseBody,
                         testing::ValuesIn(stability::bodies().begin(), stability::bodies().end()),
                         [](const auto& info) {
                           std::string name = info.param.name;
                           std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
                           return name;
                         });

/// Quadrics that are expected of one body's tessellation: each sheet of a hyperboloid is one of its own.
std::size_t pieces(const QuadricShape& shape) { return shape.type == QuadricType::hyperboloid2 ? 2 : 1; }

TEST_P(RecogniseBody, IsFoundInAnyPoseAndKeepsItsPromise) {
  const QuadricShape& shape = GetParam().shape;
  if (shape.type == QuadricType::general) GTEST_SKIP() << "an ellipsoid cut by a slanted box stays triangles";
  for (int i = 0; i < 8; ++i) {
    Random random(4, i);
    const Affine pose = Affine::translate(random.between(0, 10) * random.direction()) * stability::turned(i) *
                        Affine::scale(glm::dvec3(std::exp(random.between(-2, 2))));
    for (const int level : {2, 3, 4}) {
      const Mesh mesh = mesh_of(*tessellate(*stability::alone(shape, pose), level)->geometry);
      const double tolerance = 0.2 * glm::length(pose.linear[0]);
      const Recognition found = recognise(mesh, tolerance);
      EXPECT_EQ(found.quadrics.size(), pieces(shape)) << i << " level " << level;
      EXPECT_TRUE(found.rest.empty());
      for (const RecognisedQuadric& q : found.quadrics) {
        EXPECT_EQ(q.shape.type, shape.type);
        EXPECT_EQ(q.shape.capped, shape.capped);
      }
      expect_kept(mesh, found, tolerance, 200);
    }
  }
}

Recognition expect_one(const Mesh& mesh, double tolerance, QuadricType type) {
  Recognition found = recognise(mesh, tolerance);
  EXPECT_EQ(found.quadrics.size(), 1u);
  EXPECT_TRUE(found.rest.empty());
  for (const RecognisedQuadric& q : found.quadrics) EXPECT_EQ(q.shape.type, type);
  expect_kept(mesh, found, tolerance);
  return found;
}

Mesh tessellated(const QuadricShape& shape, int level, const Affine& pose = {}) {
  return mesh_of(*tessellate(*stability::alone(shape, pose), level)->geometry);
}

TEST(Recognise, TakesEveryBodyFromItsResidualOnAndNotBefore) {
  for (const stability::Body& body : stability::bodies()) {
    if (body.shape.type == QuadricType::general) continue;
    const Mesh mesh = tessellated(body.shape, 3, stability::turned(2));
    const Recognition found = recognise(mesh, 0.2);
    for (const RecognisedQuadric& q : found.quadrics) {
      EXPECT_EQ(recognise(mesh, 1.001 * q.residual).quadrics.size(), found.quadrics.size()) << body.name;
      const Recognition none = recognise(mesh, 0.999 * q.residual);
      EXPECT_NE(none.rest.size() + none.quadrics.size(), found.rest.size() + found.quadrics.size()) << body.name;
    }
  }
}

TEST(Recognise, FindsConesCutOffAtAnyHeight) {
  for (const double low : {0.05, 0.5, 0.9, 0.98})
    for (const bool capped : {false, true}) {
      const Mesh mesh = tessellated(stability::clipped(QuadricType::cone, low, 1, capped), 3, stability::turned(3));
      const Recognition found = expect_one(mesh, 0.05, QuadricType::cone);
      EXPECT_NEAR((*found.quadrics.at(0).shape.clip)[0], low, 1e-9);
    }
}

TEST(Recognise, FindsEllipsoids) {
  const Affine pose = stability::turned(1) * Affine::scale({1, 2, 0.7});
  expect_one(mapped(subdivided_sphere(4), pose), 0.05, QuadricType::sphere);
  expect_one(soup(mapped(subdivided_sphere(4), pose)), 0.05, QuadricType::sphere);
}

TEST(Recognise, FindsTubesWithEllipticSections) {
  const Affine pose = stability::turned(1) * Affine::scale({1, 1.5, 2});
  expect_one(tessellated({.type = QuadricType::paraboloid}, 4, pose), 0.1, QuadricType::paraboloid);
  expect_one(tessellated({.type = QuadricType::hyperboloid1}, 4, pose), 0.1, QuadricType::hyperboloid1);
}

TEST(Recognise, TurnsBoresInsideOut) {
  for (const QuadricType type : {QuadricType::cylinder, QuadricType::cone, QuadricType::hyperboloid1}) {
    const Mesh mesh = flipped(tessellated(stability::clipped(type, 0.4, 1), 4, stability::turned(1)));
    const Recognition found = expect_one(mesh, 0.05, QuadricType::general);
    GeometryBuilder builder;  // seen from the axis, whose wall it is
    builder.add(found.quadrics.at(0).shape, 0, found.quadrics.at(0).to_world);
    const auto geometry = builder.build();
    const Ray ray{stability::turned(1).point({0, 0, 0.7}), 0, stability::turned(1).vector({1, 0, 0}), infinity};
    Hit hit;
    make_tracer("bvh", geometry, {.threads = 1})->closest({&ray, 1}, {&hit, 1}, RayClass::bounce);
    ASSERT_TRUE(hit.hit());
    EXPECT_LT(glm::dot(glm::dvec3(hit.normal), ray.direction), -0.5);
  }
}

/// What a function makes of a grid of cells, [0, 1]^2.
template <class Surface>
Mesh grid(int columns, int rows, Surface surface) {
  Mesh mesh;
  for (int y = 0; y <= rows; ++y)
    for (int x = 0; x <= columns; ++x)
      mesh.positions.push_back(surface(static_cast<double>(x) / columns, static_cast<double>(y) / rows));
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const std::uint32_t at = y * (columns + 1) + x, above = at + columns + 1;
      mesh.triangles.push_back({at, at + 1, above + 1});
      mesh.triangles.push_back({at, above + 1, above});
    }
  return mesh;
}

TEST(Recognise, FindsRectangles) {
  const Mesh mesh =
      mapped(grid(4, 3, [](double u, double v) { return glm::dvec3(5 * u, v, 0); }), stability::turned(2));
  const Recognition found = expect_one(mesh, 1e-6, QuadricType::plane);
  EXPECT_LT(found.quadrics.at(0).residual, 1e-12);
}

Mesh sector(double angle) {
  return grid(12, 2, [&](double u, double v) { return glm::dvec3(std::cos(angle * u), std::sin(angle * u), 3 * v); });
}

TEST(Recognise, FindsSectorsOfCylinders) {
  for (const double angle : {0.5, 1.57, 3.14159, 5.})
    for (const bool inward : {false, true}) {
      const Mesh mesh = mapped(inward ? flipped(sector(angle)) : sector(angle), stability::turned(2));
      expect_one(mesh, 0.1, QuadricType::general);
    }
}

TEST(Recognise, FindsTheRoundEndsOfASlot) {
  Mesh mesh;  // a wall along two half circles and two straight lines, which it joins without an edge
  constexpr int half = 16;
  for (int i = 0; i < 2 * (half + 1); ++i) {
    const bool right = i <= half;
    const double a = std::numbers::pi * ((right ? i : i - 1) % (2 * half)) / half - 0.5 * std::numbers::pi;
    for (const double z : {0., 2.}) mesh.positions.push_back({(right ? 5 : -5) + std::cos(a), std::sin(a), z});
  }
  const auto count = static_cast<std::uint32_t>(mesh.positions.size());
  for (std::uint32_t at = 0; at < count; at += 2) {
    mesh.triangles.push_back({at, (at + 2) % count, (at + 3) % count});
    mesh.triangles.push_back({at, (at + 3) % count, at + 1});
  }
  const Recognition found = recognise(mesh, 0.01);
  EXPECT_EQ(found.quadrics.size(), 2u);
  EXPECT_EQ(found.rest.size(), 4u);
  expect_kept(mesh, found, 0.01);
}

TEST(Recognise, KeepsItsPromiseOnBodiesWithNoise) {
  std::size_t quadrics = 0;
  for (int i = 0; i < 60; ++i) {
    Random random(5, i);
    const auto bodies = stability::bodies();
    Mesh mesh = tessellated(bodies[random.below(bodies.size() - 1)].shape, 3, stability::turned(i));
    const double noise = std::pow(10., random.between(-7, -2));
    for (glm::dvec3& p : mesh.positions) p += noise * random.direction();
    const double tolerance = std::pow(10., random.between(-2.5, -0.5));
    const Recognition found = recognise(mesh, tolerance);
    quadrics += found.quadrics.size();
    expect_kept(mesh, found, tolerance, 200);
  }
  EXPECT_GT(quadrics, 10u);
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

Mesh waves(int cells) {
  return grid(cells, cells,
              [](double u, double v) { return glm::dvec3(u, v, 0.1 * std::sin(9 * u) * std::cos(7 * v)); });
}

TEST(MayHoldQuadrics, TellsTessellationsFromFreeForms) {
  for (const stability::Body& body : stability::bodies())
    EXPECT_TRUE(body.shape.type == QuadricType::general ||
                may_hold_quadrics(tessellated(body.shape, 3, stability::turned(1))))
        << body.name;
  Mesh free = subdivided_sphere(5);
  for (glm::dvec3& p : free.positions) p *= 1 + 0.1 * std::sin(7 * p.x) * std::cos(5 * p.y + p.z);
  EXPECT_FALSE(may_hold_quadrics(free));
  append(free, sphere(1, {0, 0, 5}));
  EXPECT_TRUE(may_hold_quadrics(free));
  EXPECT_FALSE(may_hold_quadrics(Mesh{}));
  Mesh rough = sphere(1, {0, 0, 0});
  Random random(6, 6);
  for (glm::dvec3& p : rough.positions) p += 1e-3 * random.direction();
  EXPECT_FALSE(may_hold_quadrics(rough));
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
