#include "engine/measure/tessellate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "cpu/reference_tracer.h"
#include "engine/measure/contestant.h"
#include "engine/measure/rays.h"
#include "engine/measure/stress/shapes.h"

namespace rayengine {
namespace {

TEST(SubdividedSphere, Has512TrianglesOnTheSphereThatFaceOutward) {
  const Mesh mesh = subdivided_sphere(3);
  ASSERT_EQ(mesh.triangles.size(), 512u);
  EXPECT_EQ(mesh.positions.size(), 258u);
  for (const glm::dvec3& p : mesh.positions) EXPECT_NEAR(glm::length(p), 1, 1e-15);
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 &a = mesh.positions[t.x], &b = mesh.positions[t.y], &c = mesh.positions[t.z];
    EXPECT_GT(glm::dot(glm::cross(b - a, c - a), a + b + c), 0);
  }
}

class Tessellate : public testing::TestWithParam<stability::Body> {};
INSTANTIATE_TEST_SUITE_P(Bodies, Tessellate, testing::ValuesIn(stability::bodies().begin(), stability::bodies().end()),
                         [](const auto& info) {
                           std::string name = info.param.name;
                           std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
                           return name;
                         });

/// Share of wrong decisions, and the mean error of t where they are right.
struct Errors {
  double wrong, t;
};

Errors errors(const std::shared_ptr<const Geometry>& geometry, int level) {
  const auto contestant = make_tessellated("tess", geometry, level, Precision::robust);
  const auto rays = random_rays(geometry->bounds, 4000);
  std::vector<Hit> exact(rays.size());
  make_reference_tracer(geometry)->closest(rays, exact, RayClass::bounce);
  contestant->poison(rays.size());
  contestant->closest(rays, RayClass::bounce);
  std::size_t wrong = 0, right = 0;
  double sum = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit hit = contestant->hit(i);
    const bool same = hit.object == exact[i].object && hit.primitive == exact[i].primitive;
    wrong += !same;
    if (!same || !hit.hit()) continue;
    ++right;
    sum += std::abs(hit.t - exact[i].t);
    EXPECT_NEAR(glm::length(hit.normal), 1, 1e-5);
  }
  EXPECT_GT(right, 100u);
  return {static_cast<double>(wrong) / static_cast<double>(rays.size()), sum / static_cast<double>(right)};
}

TEST_P(Tessellate, ComesNearerToTheSurfaceAndItsPartsLevelByLevel) {
  const auto geometry = stability::alone(GetParam().shape, stability::turned(1));
  const Errors coarse = errors(geometry, 2), fine = errors(geometry, 4);
  EXPECT_LT(fine.wrong, 0.01);
  EXPECT_LT(fine.t, 0.01);
  EXPECT_LE(fine.wrong, 0.5 * coarse.wrong + 1e-3);
  EXPECT_LE(fine.t, 0.5 * coarse.t + 1e-6);
}

TEST_P(Tessellate, HasFourTimesTheTrianglesAtTheNextLevelOrTwiceAsManyWhereItIsStraight) {
  const auto geometry = stability::alone(GetParam().shape);
  const auto two = tessellate(*geometry, 2), three = tessellate(*geometry, 3);
  const double ratio =
      static_cast<double>(three->geometry->triangles.size()) / static_cast<double>(two->geometry->triangles.size());
  EXPECT_GT(ratio, 1.9);
  EXPECT_LT(ratio, 4.6);
  EXPECT_EQ(three->parts.size(), three->geometry->triangles.size());
}

TEST(Tessellation, KeepsMeshesAndObjects) {
  GeometryBuilder builder;
  builder.add(stability::cube());
  builder.add(QuadricShape{.type = QuadricType::cylinder, .capped = true});
  builder.add(stability::corner_triangle(1));
  const auto made = tessellate(*builder.build(), 1);
  ASSERT_EQ(made->geometry->objects.size(), 3u);
  EXPECT_EQ(made->parts.front(), no_id);
  EXPECT_EQ(made->parts.back(), no_id);
  for (const std::uint32_t part : {0u, 1u, 2u}) EXPECT_GT(std::ranges::count(made->parts, part), 4);
}

TEST(Tessellation, RefusesWhatHasNoEndAndWhatHasNoQuadrics) {
  const auto none = [](const QuadricShape& shape) { return !tessellate(*stability::alone(shape), 1); };
  EXPECT_TRUE(none(stability::clipped(QuadricType::cylinder, 0, infinity)));
  EXPECT_TRUE(none(stability::of_form({1, 0, 0, 0, 1, 0, 0, 1, 0, -1})));
  EXPECT_TRUE(none(stability::clipped(QuadricType::saddle, -1, 0.5)));
  EXPECT_FALSE(none({.type = QuadricType::plane}));
  EXPECT_FALSE(tessellate(*stability::alone(stability::cube()), 1));
}

}  // namespace
}  // namespace rayengine
