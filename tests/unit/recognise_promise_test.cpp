#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "accel/random.h"
#include "engine/measure/stress/shapes.h"
#include "engine/measure/tessellate.h"
#include "engine/plan/recognise/recognise.h"
#include "recognise_meshes.h"

namespace rayengine {
namespace {

using namespace test;

/// How far the flattest point of any triangle is within the unit sphere.
double sagitta(const Mesh& unit_sphere) {
  double most = 0;
  for (const glm::uvec3& t : unit_sphere.triangles) {
    const glm::dvec3 &a = unit_sphere.positions[t.x], &b = unit_sphere.positions[t.y], &c = unit_sphere.positions[t.z];
    most = std::max(most, 1 - glm::dot(a, glm::normalize(glm::cross(b - a, c - a))));
  }
  return most;
}

TEST(RecognisePromise, TakesASphereFromItsSagittaOnAndNotBefore) {
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

TEST(RecognisePromise, TakesEveryBodyFromItsResidualOnAndNotBefore) {
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

TEST(RecognisePromise, KeepsItsPromiseOnSpheresWithNoise) {
  for (int i = 0; i < 40; ++i) {
    Random random(2, i);
    Mesh mesh = sphere(1, {random.between(-9, 9), 0, 0}, 2);
    const double noise = std::pow(10., random.between(-6, -1));
    for (glm::dvec3& p : mesh.positions) p += noise * random.direction();
    const double tolerance = random.between(0.02, 0.2);
    expect_kept(mesh, recognise(mesh, tolerance), tolerance);
  }
}

TEST(RecognisePromise, KeepsItsPromiseOnBodiesWithNoise) {
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

/// One thing that goes wrong with meshes.
void damage(Mesh& mesh, Random& random) {
  auto& triangles = mesh.triangles;
  const std::size_t t = random.below(triangles.size()), v = random.below(mesh.positions.size());
  const glm::dvec3 direction = random.direction();
  switch (random.below(7)) {
    case 0: triangles.erase(triangles.begin() + static_cast<std::ptrdiff_t>(t)); break;
    case 1: std::swap(triangles[t].x, triangles[t].y); break;
    case 2: mesh.positions[v] += std::pow(10., random.between(-6, 0)) * direction; break;
    case 3: triangles.push_back(triangles[t]); break;
    case 4: triangles[t].x = static_cast<std::uint32_t>(v); break;
    case 5:  // beyond a plane, all is pressed flat
      for (glm::dvec3& p : mesh.positions) p -= std::max(glm::dot(p, direction) - 0.5, 0.) * direction;
      break;
    default:  // or cut off along edges
      std::erase_if(triangles, [&](const glm::uvec3& c) { return glm::dot(mesh.positions[c.x], direction) > 0.5; });
  }
}

TEST(RecognisePromise, KeepsItsPromiseOnDamagedMeshes) {
  std::size_t quadrics = 0;
  const auto bodies = stability::bodies();
  for (int i = 0; i < 150; ++i) {
    Random random(7, i);
    Mesh mesh;
    for (std::size_t k = 0; k < 1 + random.below(3); ++k) {
      const Mesh body =
          tessellated(bodies[random.below(bodies.size() - 1)].shape, 1 + static_cast<int>(random.below(3)),
                      Affine::translate(random.direction()) * stability::turned(i));
      append(mesh, random.below(3) == 0 ? flipped(body) : body);
    }
    for (std::size_t k = random.below(4); k-- > 0 && mesh.triangles.size() > 1;) damage(mesh, random);
    const double tolerance = std::pow(10., random.between(-3, 0.5));
    const Recognition found = recognise(mesh, tolerance);
    quadrics += found.quadrics.size();
    expect_kept(mesh, found, tolerance, 100);
  }
  EXPECT_GT(quadrics, 100u);
}

TEST(RecognisePromise, KeepsItsPromiseAtAnyScaleAndDistance) {
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

}  // namespace
}  // namespace rayengine
