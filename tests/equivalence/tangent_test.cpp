// Rays that touch a surface and do not cross it: a tangent, or a cone's apex. Both are misses, on every tracer. The
// numbers are such that no tracer has anything to round.

#include <gtest/gtest.h>

#include <tuple>

#include "accel/geometry.h"
#include "engine/tracers.h"

namespace rayengine {
namespace {

struct Touch {
  const char* name;
  QuadricType type;
  bool capped;
  Ray touching, crossing;  ///< the second beside the first, to show that there is something to hit
  double t;                ///< where the first hits after all, a cap; else infinity
};

Ray ray(glm::dvec3 origin, glm::dvec3 direction) { return {origin, 0, direction, infinity}; }

const Touch touches[] = {
    {"sphere", QuadricType::sphere, false, ray({-4, 1, 0}, {1, 0, 0}), ray({-4, 0.5, 0}, {1, 0, 0}), infinity},
    {"cylinder", QuadricType::cylinder, true, ray({-4, 1, 0.5}, {1, 0, 0}), ray({-4, 0.5, 0.5}, {1, 0, 0}), infinity},
    {"apex_from_beside", QuadricType::cone, false, ray({-2, 0, 0}, {1, 0, 0}), ray({-2, 0, 0.5}, {1, 0, 0}), infinity},
    {"apex_from_below", QuadricType::cone, false, ray({0, 0, -1}, {0, 0, 1}), ray({0.5, 0, -1}, {0, 0, 1}), infinity},
    {"apex_to_the_cap", QuadricType::cone, true, ray({0, 0, -1}, {0, 0, 1}), ray({0.5, 0, -1}, {0, 0, 1}), 2},
    {"along_a_cone", QuadricType::cone, false, ray({-1, 0, -1}, {1, 0, 1}), ray({-1.5, 0, -1}, {1, 0, 1}), infinity},
};

class Tangent : public testing::TestWithParam<std::tuple<const char*, Precision, Touch>> {};

std::string name_of(const testing::TestParamInfo<Tangent::ParamType>& info) {
  const std::string precision(to_string(std::get<Precision>(info.param)));
  return std::get<0>(info.param) + ("_" + precision + "_") + std::get<Touch>(info.param).name;
}
INSTANTIATE_TEST_SUITE_P(Tracers, Tangent,
                         testing::Combine(testing::Values("reference", "embree", "stream", "objects"),
                                          testing::Values(Precision::fast, Precision::robust),
                                          testing::ValuesIn(touches)),
                         name_of);
INSTANTIATE_TEST_SUITE_P(InDouble, Tangent,
                         testing::Combine(testing::Values("bvh"), testing::Values(Precision::robust),
                                          testing::ValuesIn(touches)),
                         name_of);

TEST_P(Tangent, IsAMiss) {
  const auto& [name, precision, touch] = GetParam();
  GeometryBuilder builder;
  builder.add(QuadricShape{.type = touch.type, .capped = touch.capped}, 0);
  const auto tracer = make_tracer(name, builder.build(), {.precision = precision});
  const Ray rays[] = {touch.touching, touch.crossing};
  for (const RayClass ray_class : {RayClass::primary, RayClass::bounce}) {
    Hit hits[2];
    tracer->closest(rays, hits, ray_class);
    EXPECT_EQ(hits[0].t, touch.t);
    EXPECT_TRUE(hits[1].hit());
  }
  const HitLists all = tracer->all(rays);
  EXPECT_EQ(all.offsets[1], touch.t < infinity ? 1u : 0u);
}

}  // namespace
}  // namespace rayengine
