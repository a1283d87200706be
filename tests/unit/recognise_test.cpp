#include "engine/plan/recognise/recognise.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "accel/random.h"
#include "accel/tracer.h"
#include "engine/measure/stress/shapes.h"
#include "engine/measure/tessellate.h"
#include "engine/tracers.h"
#include "recognise_meshes.h"

namespace rayengine {
namespace {

using namespace test;
using stability::mapped;

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

/// All but the ellipsoid that a slanted box cuts, which stays triangles.
std::vector<stability::Body> recognisable_bodies() {
  std::vector<stability::Body> bodies;
  for (const stability::Body& body : stability::bodies())
    if (body.shape.type != QuadricType::general) bodies.push_back(body);
  return bodies;
}

class RecogniseBody : public testing::TestWithParam<stability::Body> {};
INSTANTIATE_TEST_SUITE_P(Bodies, RecogniseBody, testing::ValuesIn(recognisable_bodies()), [](const auto& info) {
  std::string name = info.param.name;
  std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
  return name;
});

/// Quadrics that are expected of one body's tessellation: each sheet of a hyperboloid is one of its own.
std::size_t pieces(const QuadricShape& shape) { return shape.type == QuadricType::hyperboloid2 ? 2 : 1; }

TEST_P(RecogniseBody, IsFoundInAnyPoseAndKeepsItsPromise) {
  const QuadricShape& shape = GetParam().shape;
  for (int i = 0; i < 8; ++i) {
    Random random(4, i);
    const Affine pose = Affine::translate(random.between(0, 10) * random.direction()) * stability::turned(i) *
                        Affine::scale(glm::dvec3(std::exp(random.between(-2, 2))));
    for (const int level : {2, 3, 4}) {
      const Mesh mesh = tessellated(shape, level, pose);
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

TEST(Recognise, FindsConesCutOffAtAnyHeight) {
  for (const double low : {0.05, 0.5, 0.9, 0.98})
    for (const bool capped : {false, true}) {
      const Mesh mesh = tessellated(stability::clipped(QuadricType::cone, low, 1, capped), 3, stability::turned(3));
      const Recognition found = expect_one(mesh, 0.05, QuadricType::cone);
      EXPECT_NEAR((*found.quadrics.at(0).shape.clip)[0], low, 1e-9);
    }
}

TEST(Recognise, FindsPartsOfSpheresBetweenPlanes) {
  for (const auto& [low, high] : {std::pair{-2., 0.}, {0.3, 2.}, {-2., 0.8}, {-0.5, 0.7}, {0.2, 0.9}})
    for (const bool inward : {false, true}) {
      const Mesh mesh = tessellated(stability::clipped(QuadricType::sphere, low, high), 4, stability::turned(3));
      const Recognition found =
          expect_one(inward ? flipped(mesh) : mesh, 0.05, inward ? QuadricType::general : QuadricType::sphere);
      EXPECT_LT(found.quadrics.at(0).residual, 0.02);
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
