// What a user sees where there is no GPU to use. Each machine is brought about by the environment: loaders and drivers
// can be told to find nothing, or to offer less.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/command.h"
#include "tests/temporary.h"

namespace rayengine {
namespace {

using nlohmann::json;

struct Machine {
  const char* name;
  const char* environment;
  const char* says;
};

class CliGpu : public testing::TestWithParam<Machine> {
 protected:
  CliGpu() {
    folder_.write("scene.nff",
                  "v\nfrom 0 -8 1\nat 0 0 1\nup 0 0 1\nangle 45\nresolution 8 8\nf 1 1 1 1 0 0 0 1\ns 0 0 0 1\n");
  }

  test::Outcome run(const std::string& arguments) const {
    return test::rayengine(folder_.path(), arguments, GetParam().environment);
  }
  std::string drivers() const {
    test::rayengine(folder_.path(), "info --json gpu.json");
    return json::parse(test::content(folder_.path() / "gpu.json"))["gpu"].dump();
  }

  test::TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(
    Without, CliGpu,
    testing::Values(Machine{"egl", "LD_LIBRARY_PATH=.", "no GPU: libEGL.so.1"},
                    Machine{"devices", "__EGL_VENDOR_LIBRARY_DIRS=.", "tried EGL, which has no device"},
                    Machine{"opengl45", "MESA_GL_VERSION_OVERRIDE=3.3", "tried device 0: no OpenGL 4.5 core context"}),
    [](const auto& info) { return info.param.name; });

TEST_P(CliGpu, TracersThatNeedOneFailWithOneLine) {
  if (GetParam().name == std::string("opengl45") && drivers().find("Mesa") == std::string::npos)
    GTEST_SKIP() << "only Mesa can be told to offer an older OpenGL";
  folder_.write("libEGL.so.1", "");
  for (const char* tracer : {"stream", "objects"}) {
    const test::Outcome outcome = run("render scene.nff -o a.png -q --tracer " + std::string(tracer));
    EXPECT_EQ(outcome.code, 1);
    EXPECT_TRUE(outcome.one_line_error()) << outcome.err;
    EXPECT_NE(outcome.err.find(GetParam().says), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("use --tracer embree"), std::string::npos) << outcome.err;
    EXPECT_FALSE(exists(folder_.path() / "a.png"));
  }
}

TEST_P(CliGpu, TheProcessorTracesAllTheSame) {
  folder_.write("libEGL.so.1", "");
  EXPECT_EQ(run("render scene.nff -o a.png -q --tracer embree").code, 0);
  const test::Outcome info = run("info");
  EXPECT_EQ(info.code, 0) << info.err;
}

}  // namespace
}  // namespace rayengine
