#include "gpu/probe.h"

#include <gtest/gtest.h>

#include "accel/tracer.h"
#include "gpu/context.h"
#include "gpu/gpu_report.h"

using namespace rayengine;

TEST(Probe, TheDeviceCanRunTheStreamTracer) {
  Context context;
  const GpuProbe p = probe(context);
  ASSERT_EQ(p.stages.size(), 2u);
  EXPECT_EQ(describe(p).size(), 3u);
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

TEST(Probe, ReportsWhatShadersCost) {
  const GpuReport report = report_on_gpu();
  EXPECT_GT(report.compile_seconds, 0);
  EXPECT_FALSE(report.info.renderer.empty());
  EXPECT_THROW(report_on_gpu(99), Error);
}
