// Breaks a kernel in each of three ways, and expects the comparison with the oracle to notice. The result that it must
// not pass is the same as in equivalence_test.cpp.

#include <gtest/gtest.h>

#include <algorithm>

#include "cpu/reference_tracer.h"
#include "engine/measure/compare.h"
#include "engine/measure/rays.h"
#include "gpu/stream/stream_tracer.h"
#include "tests/equivalence/cases.h"

namespace rayengine {
namespace {

struct Mutant {
  const char* define;
  const char* scene;
};

class Mutation : public testing::TestWithParam<Mutant> {
 protected:
  std::uint64_t beyond_bounds(const std::vector<std::string>& defines) const {
    const auto cases = test::all_cases();
    const auto& scene =
        *std::find_if(cases.begin(), cases.end(), [](const auto& c) { return c.name == GetParam().scene; });
    StreamOptions options;
    options.defines = defines;
    const auto stream = make_stream_tracer(scene.geometry, Precision::robust, options);
    const auto oracle = make_reference_tracer(scene.geometry);
    return compare(*stream, *oracle, *scene.geometry, random_rays(scene.geometry->bounds, 500), RayClass::primary)
        .beyond_bounds;
  }
};
INSTANTIATE_TEST_SUITE_P(Kernels, Mutation,
                         testing::Values(Mutant{"MUTANT_ROOT", "sphere"}, Mutant{"MUTANT_CLIP", "cylinder"},
                                         Mutant{"MUTANT_INDEX", "torus"}),
                         [](const auto& info) { return std::string(info.param.define); });

TEST_P(Mutation, IsNoticed) {
  EXPECT_EQ(beyond_bounds({}), 0u);
  EXPECT_GT(beyond_bounds({GetParam().define}), 20u);
}

}  // namespace
}  // namespace rayengine
