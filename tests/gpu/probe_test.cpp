#include "gpu/device/probe.h"

#include <gtest/gtest.h>

#include "accel/tracer.h"
#include "gpu/device/context.h"
#include "gpu/device/gpu_report.h"
#include "tests/temporary.h"

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
  const test::TemporaryFolder cache;
  setenv("XDG_CACHE_HOME", cache.path().c_str(), 1);
  const GpuReport first = report_on_gpu(), second = report_on_gpu();
  unsetenv("XDG_CACHE_HOME");
  EXPECT_GT(first.compile_seconds, 0);
  EXPECT_FALSE(first.cached);
  EXPECT_EQ(second.cached, !std::filesystem::is_empty(cache.path()));
  EXPECT_FALSE(first.info.renderer.empty());
  EXPECT_THROW(report_on_gpu(99), Error);
}
