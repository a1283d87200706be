#include "gpu/probe.h"

#include <gtest/gtest.h>

#include "gpu/context.h"

using namespace rayengine;

TEST(Probe, TheDeviceCanRunTheStreamTracer) {
  Context context;
  const GpuProbe p = probe(context);
  ASSERT_EQ(p.stages.size(), 2u);
  for (const std::string& line : describe(p)) std::printf("%s\n", line.c_str());
  EXPECT_TRUE(p.refusals().empty());
  for (const ArithmeticProbe& stage : p.stages) {
    EXPECT_TRUE(stage.two_sum_exact) << stage.stage;
    EXPECT_LE(stage.division_ulps, 2.5) << stage.stage;  // what GLSL promises
    EXPECT_LE(stage.sqrt_ulps, 3.0) << stage.stage;
  }
}

TEST(Probe, RefusesWhatTracingRestsOn) {
  GpuProbe p{{{.stage = "fragment", .precise_holds = false}}, false, true};
  EXPECT_EQ(p.refusals().size(), 2u);
}
