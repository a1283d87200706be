// Quadrics in general form that are of another type: each type is known by its numbers, whatever looks like one and is
// none stays, and exact arithmetic sees the same surface before and after.

#include "engine/plan/canonical.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/plan/planned.h"
#include "engine/plan/verify.h"
#include "engine/tracers.h"

namespace rayengine {
namespace {

constexpr Tolerance exact{0}, tenth_of_pixel{0.1};
const Box everywhere{glm::dvec3(-infinity), glm::dvec3(infinity)};
const Box cube{glm::dvec3(-1), glm::dvec3(1)};

QuadricShape general(const QuadricMatrix& matrix, const Box& box = everywhere) {
  return {.type = QuadricType::general, .matrix = matrix, .box = box};
}

/// A type's own matrix times a number, and with its own box where it has one.
QuadricShape multiple(QuadricType type, double by, const Box& box) {
  QuadricMatrix matrix = unit_matrix(type);
  for (double& a : matrix) a *= by;
  return general(matrix, box);
}

const Affine somewhere =
    Affine::translate({0.3, -0.7, 1.9}) * Affine::rotate({1, 2, 3}, 40) * Affine::scale({0.7, 1.1, 0.9});

std::optional<CanonicalQuadric> taken_for(const QuadricShape& shape) {
  GeometryBuilder builder;
  builder.add(shape, 0, somewhere);
  const auto geometry = builder.build();
  return canonical(geometry->quadrics[0], geometry->forms[0]);
}

constexpr QuadricType known[] = {QuadricType::sphere,     QuadricType::cylinder,     QuadricType::cone,
                                 QuadricType::paraboloid, QuadricType::hyperboloid1, QuadricType::hyperboloid2,
                                 QuadricType::saddle,     QuadricType::plane};

Box own_box(QuadricType type) {
  Box box = everywhere;
  if (type == QuadricType::saddle) return cube;
  if (type != QuadricType::plane) box.lower.z = -0.5, box.upper.z = 1.75;
  return box;
}

TEST(Canonical, KnowsEveryTypeByAnyMultipleOfItsNumbers) {
  for (const QuadricType type : known)
    for (const double by : {1.0, 0.3, 5.0}) {
      const auto found = taken_for(multiple(type, by, own_box(type)));
      ASSERT_TRUE(found) << to_string(type);
      EXPECT_EQ(found->quadric.type, type);
      EXPECT_EQ(found->distance, 0);
      EXPECT_EQ(found->quadric.zmin, own_box(type).lower.z) << to_string(type);
      EXPECT_EQ(found->quadric.zmax, own_box(type).upper.z) << to_string(type);
    }
}

TEST(Canonical, LeavesWhatIsAnotherSurface) {
  for (const QuadricType type : known) {
    EXPECT_FALSE(taken_for(multiple(type, -1, own_box(type)))) << to_string(type) << " that faces inwards";
    for (const int place : {1, 2, 3, 5, 6}) {
      QuadricShape shape = multiple(type, 1, own_box(type));
      (*shape.matrix)[place] = 1e-9;
      EXPECT_FALSE(taken_for(shape)) << to_string(type) << " with another number " << place;
    }
  }
  EXPECT_FALSE(taken_for(general({1, 0, 0, 0, 1, 0, 0, 1, 1e-9, -1}))) << "a sphere beside its centre";
  EXPECT_FALSE(taken_for(general({1, 0, 0, 0, 1, 0, 0, 1, 0, 1}))) << "no real surface";
  EXPECT_FALSE(taken_for(general({1, 0, 0, 0, 0, 0, 0, 0, 0, -1}))) << "two planes";
  EXPECT_FALSE(taken_for(general({0, 0, 0, 0, 0, 0, 0, 0, 0, 0}))) << "nothing at all";
}

TEST(Canonical, LeavesWhatItsBoxCuts) {
  const Box half{{-infinity, -infinity, -infinity}, {0.5, infinity, infinity}};
  for (const QuadricType type : known) EXPECT_FALSE(taken_for(multiple(type, 1, half))) << to_string(type);
  EXPECT_FALSE(taken_for(multiple(QuadricType::saddle, 1, everywhere)));
  EXPECT_FALSE(taken_for(multiple(QuadricType::plane, 1, cube)));
  EXPECT_FALSE(taken_for(multiple(QuadricType::cone, 1, cube)));
  const auto ball = taken_for(multiple(QuadricType::sphere, 1, cube));
  ASSERT_TRUE(ball) << "a box that holds all of it cuts nothing";
  EXPECT_EQ(ball->quadric.zmin, -infinity);
  EXPECT_EQ(taken_for(multiple(QuadricType::cylinder, 1, cube))->quadric.zmax, 1);
}

TEST(Canonical, KnowsHowFarAScaleRounds) {
  const auto quarter = taken_for(general({1, 0, 0, 0, 4, 0, 0, 16, 0, -0.25}));
  ASSERT_TRUE(quarter);
  EXPECT_EQ(quarter->distance, 0) << "a power of two rounds nothing";
  const auto odd = taken_for(general({1, 0, 0, 0, 3, 0, 0, 5, 0, -7}));
  ASSERT_TRUE(odd);
  EXPECT_EQ(odd->quadric.type, QuadricType::sphere);
  EXPECT_GT(odd->distance, 0);
  EXPECT_LT(odd->distance, 1e-13);
  EXPECT_FALSE(taken_for(general({3, 0, 0, 0, 5, 0, 0, 0, 0, -7}))) << "endless: so is the distance";
  EXPECT_FALSE(taken_for(general({1, 0, 0, 0, 1, 0, 0, 5, 0, -7}, {{-9, -9, -1}, {9, 9, 1}})))
      << "its clip would be rounded";
  EXPECT_FALSE(taken_for(general({1e300, 0, 0, 0, 1e300, 0, 0, 1e300, 0, -1e-300})));
}

/// All types, and ellipsoids on scales that round and that do not, in a row.
Scene row() {
  Scene scene;
  GeometryBuilder builder;
  double x = -12;
  const auto add = [&](const QuadricShape& shape) {
    x += 2.5;
    builder.add(shape, 0, Affine::translate({x, 0.1, 0}) * Affine::rotate({1, 2, 3}, 40 + 5 * x));
  };
  for (const QuadricType type : known)
    if (type != QuadricType::plane) add(multiple(type, 0.3, own_box(type)));
  add(general({1, 0, 0, 0, 4, 0, 0, 4, 0, -1}));
  add(general({3, 0, 0, 0, 2, 0, 0, 5, 0, -1.1}));
  add(general({1, 0.1, 0, 0, 1, 0, 0, 1, 0, -1}, {glm::dvec3(-2), glm::dvec3(2)}));
  scene.geometry = builder.build();
  scene.camera = {.from = {1, -24, 7}, .at = {1, 0, 0}, .fov = 40, .size = {512, 512}};
  return scene;
}

std::size_t general_left(const Scene& scene) {
  std::size_t count = 0;
  for (const Quadric& q : scene.geometry->quadrics) count += q.type == QuadricType::general;
  return count;
}

TEST(Canonical, ExactArithmeticSeesTheSame) {
  const Scene scene = row();
  const auto rays = random_camera_rays(scene.camera, 20000);
  for (const Tolerance& tolerance : {exact, tenth_of_pixel}) {
    const Planned planned = plan_scene(scene, {.tolerance = tolerance, .rays = 1e6});
    EXPECT_EQ(general_left(planned.model.scene), tolerance.value == 0 ? 2u : 1u);
    const auto tracer = make_tracer(planned.tracing.tracer, planned.model.scene.geometry, options_of(planned.tracing));
    const Verification found = verify(scene, planned.model.scene, *tracer, tolerance, rays);
    EXPECT_EQ(found.broken, 0u) << tolerance.value;
    EXPECT_GT(found.hits, 1000u);
  }
}

TEST(Canonical, OnlyWhatIsKnownToBeExactIsReplacedAtZero) {
  const CanonicalScene at_zero = in_canonical_forms(row(), exact), above = in_canonical_forms(row(), tenth_of_pixel);
  EXPECT_EQ(at_zero.choices.front().subject, "2 quadrics in general form");
  EXPECT_EQ(above.choices.front().subject, "3 quadrics in general form");
  EXPECT_EQ(above.choices.front().chosen, "spheres");
  EXPECT_EQ(above.choices.size(), 7u);
  EXPECT_TRUE(above.scene.geometry->bounds.finite()) << "which spheres have, and general forms without a box not";
  const CanonicalScene again = in_canonical_forms(above.scene, tenth_of_pixel);
  EXPECT_EQ(again.scene.geometry, above.scene.geometry);
  EXPECT_TRUE(again.choices.empty());
}

}  // namespace
}  // namespace rayengine
