// Ray cones are conservative: with 113 bits no ray leaves its cone, and no sphere that a ray meets is culled.

#include "accel/ray_cone.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "accel/kernels/kernels.h"
#include "accel/rounding.h"
#include "tests/ray_tiles.h"

namespace rayengine {
namespace {

using test::holds, test::WidePoint, test::somewhere, test::bundle, test::Tile, test::Wide;

class ConeOf : public testing::TestWithParam<test::TileKind> {};
INSTANTIATE_TEST_SUITE_P(Tiles, ConeOf, testing::ValuesIn(test::tile_kinds),
                         [](const auto& info) { return info.param.name; });

constexpr std::uint64_t tiles = 300;

TEST_P(ConeOf, HoldsItsRays) {
  for (std::uint64_t seed = 0; seed < tiles; ++seed) {
    Random random(seed, 1);
    const Tile tile = GetParam().make(random);
    const RayCone cone = enclosing_cone(tile);
    ASSERT_LE(cone.cosine, 1);
    for (const ConeRay& ray : tile) ASSERT_TRUE(holds(cone, ray)) << "tile " << seed;
  }
}

/// A sphere that the ray touches from outside at t: the hardest to keep.
void expect_held(const RayCone& cone, const ConeRay& ray, Random& random) {
  const double radius = std::pow(10, random.between(-6, 2)), t = std::pow(10, random.between(-6, 3));
  const glm::dvec3 d = glm::normalize(glm::dvec3(ray.direction)), o(ray.origin);
  const glm::dvec3 side = glm::normalize(glm::cross(d, random.direction()));
  const glm::vec3 center(o + t * d + radius * side);
  const WidePoint to(WidePoint(center) - WidePoint(ray.origin));
  const Wide along = dot(to, WidePoint(ray.direction)), dd = dot(WidePoint(ray.direction), WidePoint(ray.direction));
  const Wide across = dot(to, to) - (along > 0 ? along * along / dd : 0);  // from the ray, not from its line
  const float reach = float_above(std::sqrt(static_cast<double>(across)) * (1 + 1e-15));
  EXPECT_TRUE(may_meet(cone, center, reach)) << "radius " << radius << ", t " << t;
}

TEST_P(ConeOf, KeepsWhatItsRaysTouch) {
  for (std::uint64_t seed = 0; seed < tiles; ++seed) {
    Random random(seed, 2);
    const Tile tile = GetParam().make(random);
    const RayCone cone = enclosing_cone(tile);
    for (const ConeRay& ray : tile) expect_held(cone, ray, random);
    ASSERT_FALSE(HasFailure()) << "tile " << seed;
  }
}

TEST(RayCone, OfNothingMeetsNothing) { EXPECT_FALSE(may_meet(enclosing_cone({}), {0, 0, 0}, 1e9f)); }

TEST(RayCone, OfOppositeRaysMeetsEverything) {
  const Tile tile{{{0, 0, 0}, {0, 0, 1}}, {{0, 0, 0}, {0, 0, -1}}};
  EXPECT_LT(enclosing_cone(tile).cosine, 0);
  EXPECT_TRUE(may_meet(enclosing_cone(tile), {5, 0, 0}, .1f));
}

/// What the cone is for: of spheres strewn about, a narrow tile keeps not many more than its rays come near.
TEST(RayCone, CullsWhatItsRaysAreFarFrom) {
  Random random(3, 3);
  std::size_t kept = 0;
  for (int i = 0; i < 200; ++i) {
    const RayCone cone = enclosing_cone(bundle(random, 256, .03, .03));
    for (int k = 0; k < 100; ++k) kept += may_meet(cone, somewhere(random, 3), .05f);
  }
  EXPECT_LT(kept, 20000u / 40);
  EXPECT_GT(kept, 20000u / 4000);
}

/// The paper's own steps, in double: each leaves the cone holding what it held.
TEST(RayCone, GrowsAsThePaperSays) {
  using Vec = kernels::Vec3<double>;
  Random random(4, 4);
  for (int turn = 0; turn < 2000; ++turn) {
    const auto vec = [](const glm::dvec3& v) { return Vec{v.x, v.y, v.z}; };
    Vec axis = vec(random.direction()), apex = vec(random.direction());
    double cosine, sine;
    kernels::cone_opened(random.between(.01, 1), cosine, sine);
    const Vec old_axis = axis;
    const double old_angle = std::atan2(sine, cosine);
    const Vec direction = vec(random.direction()), point = vec(3. * random.direction());
    const double apart = std::acos(kernels::inner(axis, direction));
    kernels::cone_extended(axis, cosine, sine, direction, axis, cosine, sine);
    if (cosine < 0) {
      EXPECT_GT((old_angle + apart) / 2, std::atan(8) - 1e-9);
      continue;
    }
    // The least cone around both: half their angles and what lies between.
    EXPECT_NEAR(std::atan2(sine, cosine), std::max(old_angle, (old_angle + apart) / 2), 1e-7);
    EXPECT_GE(kernels::inner(axis, direction), cosine - 1e-12);
    const double turned = std::acos(std::min(kernels::inner(axis, old_axis), 1.));
    EXPECT_LE(turned + old_angle, std::atan2(sine, cosine) + 1e-7);
    const Vec moved = kernels::cone_translated(apex, axis, cosine, sine, point);
    for (const Vec& held : {point, apex}) {
      const Vec w = kernels::combined(1., held, -1., moved);
      const double length = std::sqrt(kernels::inner(w, w));
      EXPECT_GE(kernels::inner(w, axis), cosine * length - 1e-9 * (1 + length));
    }
  }
}

TEST(EnclosingSphere, OfATriangleIsTheSmallest) {
  const auto expect = [](const Sphere& s, glm::dvec3 center, double radius) {
    EXPECT_NEAR(s.radius, radius, 1e-12);
    EXPECT_LT(glm::distance(s.center, center), 1e-12);
  };
  const double third = std::sqrt(3.) / 2;
  expect(enclosing_sphere({1, 0, 0}, {-.5, third, 0}, {-.5, -third, 0}), {0, 0, 0}, 1);  // acute: its circle
  for (const double z : {.1, 1e-9, 0.}) {  // obtuse, down to none: its longest side
    expect(enclosing_sphere({-1, 0, 0}, {1, 0, 0}, {.2, 0, z}), {0, 0, 0}, 1);
    expect(enclosing_sphere({1, 0, 0}, {.2, 0, z}, {-1, 0, 0}), {0, 0, 0}, 1);
    expect(enclosing_sphere({.2, 0, z}, {-1, 0, 0}, {1, 0, 0}), {0, 0, 0}, 1);
  }
  expect(enclosing_sphere({2, 2, 2}, {2, 2, 2}, {2, 2, 2}), {2, 2, 2}, 0);
}

Sphere around(const QuadricShape& shape, const Affine& place) {
  GeometryBuilder builder;
  builder.add(shape, 0, place);
  const auto geometry = builder.build();
  return enclosing_sphere(*geometry, geometry->quadrics.front());
}

TEST(EnclosingSphere, OfAPlacedSphereIsItself) {
  const Affine place = Affine::translate({1, 2, 3}) * Affine::rotate({1, 1, 0}, 30);
  const Sphere round = around({}, place * Affine::scale(glm::dvec3(.5)));
  EXPECT_NEAR(round.radius, .5, 1e-9);
  EXPECT_LT(glm::distance(round.center, {1, 2, 3}), 1e-9);
  EXPECT_NEAR(around({}, place * Affine::scale({.5, 2, 1})).radius, 2, 1e-9);
}

TEST(EnclosingSphere, HoldsEveryTypeAsFarAsItIsClipped) {
  Random random(5, 5);
  for (std::size_t i = 0; i + 1 < quadric_type_count; ++i) {
    const auto type = static_cast<QuadricType>(i);
    const Affine place = Affine::translate({3, 1, 0}) * Affine::rotate({1, 2, 1}, 50) * Affine::scale({1, 2, .5});
    const Sphere sphere = around({.type = type}, place);
    if (type == QuadricType::plane) {
      EXPECT_EQ(sphere.radius, infinity);
      continue;
    }
    // The rim, where there is one; else, on saddle and sphere, points of the surface.
    for (int k = 0; k < 1000; ++k) {
      const double around = random.between(0, 2 * std::numbers::pi), x = std::cos(around), y = std::sin(around);
      glm::dvec3 p(random.direction());
      if (type == QuadricType::cylinder || type == QuadricType::cone || type == QuadricType::paraboloid) p = {x, y, 1};
      if (type == QuadricType::hyperboloid1) p = {std::sqrt(2) * x, std::sqrt(2) * y, k % 2 ? 1 : -1};
      if (type == QuadricType::hyperboloid2) p = {std::sqrt(3) * x, std::sqrt(3) * y, k % 2 ? 2 : -2};
      if (type == QuadricType::saddle) p = {p.x, p.y, p.x * p.x - p.y * p.y};
      if (type == QuadricType::disk) p = {x, y, 0};
      EXPECT_LE(glm::distance(place.point(p), sphere.center), sphere.radius * (1 + 1e-12)) << to_string(type);
    }
  }
}

}  // namespace
}  // namespace rayengine
