// Lines through the rims of capped quadrics, where the side and the cap are met at one t: lists of all hits count where
// the line passes between inside and outside. The numbers are such that every rim is met exactly.

#include <gtest/gtest.h>

#include <tuple>

#include "accel/geometry.h"
#include "engine/tracers.h"

namespace rayengine {
namespace {

using enum QuadricType;

struct Solid {
  const char* name;
  QuadricType type;
  std::array<double, 2> clip;
  std::vector<glm::dvec3> rim;  ///< points of it
};

const Solid solids[] = {
    {"cylinder", cylinder, {0, 1}, {{1, 0, 0}, {0, -1, 0}, {-1, 0, 1}, {0, 1, 1}}},
    {"cone", cone, {0, 1.25}, {{1.25, 0, 1.25}, {.75, -1, 1.25}}},
    {"frustum", cone, {.625, 1.25}, {{.375, .5, .625}, {.75, 1, 1.25}, {-1.25, 0, 1.25}}},
    {"nappes", cone, {-1, 1.25}, {{0, 1, -1}, {-.75, 1, 1.25}}},
    {"paraboloid", paraboloid, {.25, 1.5625}, {{.5, 0, .25}, {.75, 1, 1.5625}, {0, -1.25, 1.5625}}},
    {"hyperboloid1", hyperboloid1, {-.75, .75}, {{1.25, 0, .75}, {-.75, 1, .75}, {.75, -1, -.75}}},
    {"waist", hyperboloid1, {0, .75}, {{1, 0, 0}, {0, -1, 0}, {.75, 1, .75}}},
    {"hyperboloid2", hyperboloid2, {-1.25, 1.25}, {{.75, 0, -1.25}, {0, -.75, 1.25}}},
    {"sheet", hyperboloid2, {1, 1.25}, {{-.75, 0, 1.25}, {0, .75, 1.25}}},
};

void add(GeometryBuilder& builder, const Solid& solid) {
  builder.add(QuadricShape{.type = solid.type, .capped = true, .clip = solid.clip});
}

/// From far enough to be in front of the whole solid.
Ray through(const glm::dvec3& point, const glm::dvec3& direction) {
  return {point - 16. * direction, 0, direction, infinity};
}

std::vector<Ray> aimed_at_rims(const Solid& solid, const Affine& map) {
  std::vector<Ray> rays;
  for (const glm::dvec3& point : solid.rim)
    for (int x = -2; x <= 2; ++x)
      for (int y = -2; y <= 2; ++y)
        for (int z = -2; z <= 2; ++z)
          if (x != 0 || y != 0 || z != 0) rays.push_back(through(map.point(point), map.vector({x, y, z})));
  return rays;
}

class Rim : public testing::TestWithParam<std::tuple<const char*, Solid>> {
 protected:
  static std::unique_ptr<Tracer> make(std::shared_ptr<const Geometry> geometry) {
    return make_tracer(std::get<0>(GetParam()), geometry, {.precision = Precision::certified});
  }
  static const Solid& solid() { return std::get<1>(GetParam()); }

  static void expect_even(std::shared_ptr<const Geometry> geometry, const Affine& map) {
    const auto rays = aimed_at_rims(solid(), map);
    const HitLists lists = make(std::move(geometry))->all(rays);
    std::size_t passing = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const std::uint64_t count = lists.offsets[i + 1] - lists.offsets[i];
      EXPECT_EQ(count % 2, 0u) << "ray " << i;
      passing += count > 0;
    }
    EXPECT_GE(passing, 20u);
    EXPECT_LT(passing, rays.size() - 20);
  }
};
INSTANTIATE_TEST_SUITE_P(Tracers, Rim, testing::Combine(testing::Values("reference", "bvh"), testing::ValuesIn(solids)),
                         [](const auto& info) {
                           return std::get<0>(info.param) + std::string("_") + std::get<1>(info.param).name;
                         });

TEST_P(Rim, IsPassedAnEvenNumberOfTimes) {
  GeometryBuilder builder;
  add(builder, solid());
  expect_even(builder.build(), {});
}

TEST_P(Rim, OfAnInstanceIsPassedAnEvenNumberOfTimes) {
  const Affine map = Affine::translate({8, -4, 2}) * Affine::scale({2, 4, -2});
  GeometryBuilder group, builder;
  add(group, solid());
  builder.add(group.build(), map);
  expect_even(builder.build(), map);
}

/// What lists of all hits hold, and the nearest hit.
struct Passage {
  const char* name;
  Solid solid;
  Ray ray;
  std::vector<std::uint32_t> parts;
  double nearest;
  std::uint32_t nearest_part, status;
};

constexpr std::uint32_t tied = status_hit | status_tie;
const Passage passages[] = {
    {"in_by_the_rim", solids[0], through({1, 0, 1}, {-1, 0, -1}), {0, 1}, 16, 0, tied},
    {"out_by_the_rim", solids[0], through({1, 0, 1}, {1, 0, 1}), {1, 0}, 15, 1, status_hit},
    {"in_and_out_by_rims", solids[0], through({1, 0, 1}, {-2, 0, -1}), {0, 0}, 16, 0, tied},
    {"touching_it_from_outside", solids[0], through({1, 0, 1}, {1, 0, -1}), {}, 16, 0, tied},
    {"along_the_wall", solids[0], through({1, 0, 0}, {0, 0, 1}), {}, 16, 1, status_hit},
    {"in_the_plane_of_a_cap", solids[0], through({1, 0, 1}, {-1, 0, 0}), {}, 16, 0, status_hit},
    {"along_a_cone", solids[1], through({1.25, 0, 1.25}, {1, 0, 1}), {}, 16, 2, status_hit},
    {"touching_the_side_from_inside", solids[6], through({1, 0, 0}, {0, 0, 1}), {1, 2}, 16, 1, status_hit},
    {"touching_the_side_from_outside", solids[6], through({1, 0, 0}, {0, 2, 1}), {}, 16, 1, status_hit},
};

class RimPassage : public testing::TestWithParam<std::tuple<const char*, Passage>> {};
INSTANTIATE_TEST_SUITE_P(Tracers, RimPassage,
                         testing::Combine(testing::Values("reference", "bvh"), testing::ValuesIn(passages)),
                         [](const auto& info) {
                           return std::get<0>(info.param) + std::string("_") + std::get<1>(info.param).name;
                         });

TEST_P(RimPassage, IsListedOnceAndATouchIsNone) {
  const auto& [name, passage] = GetParam();
  GeometryBuilder builder;
  add(builder, passage.solid);
  const auto tracer = make_tracer(name, builder.build(), {.precision = Precision::certified});
  std::vector<std::uint32_t> parts;
  for (const Hit& hit : tracer->all({&passage.ray, 1}).hits) parts.push_back(hit.primitive);
  EXPECT_EQ(parts, passage.parts);
  Hit nearest;
  tracer->closest({&passage.ray, 1}, {&nearest, 1}, RayClass::primary);
  EXPECT_EQ(nearest.t, passage.nearest);
  EXPECT_EQ(nearest.primitive, passage.nearest_part);
  EXPECT_EQ(nearest.status & ~status_resolved, passage.status);
}

}  // namespace
}  // namespace rayengine
