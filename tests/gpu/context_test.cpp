#include "gpu/device/context.h"

#include <epoxy/gl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "accel/tracer.h"
#include "gpu/device/program.h"

using namespace rayengine;

TEST(Context, IsOpenGl45) {
  Context context;
  EXPECT_GE(epoxy_gl_version(), 45);
  EXPECT_FALSE(context.info().renderer.empty());
  EXPECT_GE(context.info().texture_size, 16384);
}

TEST(Context, LeavesPointsWhatTheyAreWhereItMay) {
  Context context(-1, Profile::compatibility);
  EXPECT_GE(epoxy_gl_version(), 45);
  GLint profile = 0;
  glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
  if (profile & GL_CONTEXT_CORE_PROFILE_BIT) GTEST_SKIP() << "this driver has the core profile alone";
  EXPECT_FALSE(glIsEnabled(GL_POINT_SPRITE));
  EXPECT_NO_THROW(context.check_errors("a test"));
}

TEST(Context, RefusesADeviceThatIsNotThereAndSaysHowManyThereAre) {
  try {
    Context context(99);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("no GPU 99: EGL lists " + std::to_string(gpu_devices().size())),
              std::string::npos);
  }
}

TEST(Context, GlErrorsAreNeverIgnored) {
  Context context;
  glEnable(0xFFFF);
  EXPECT_THROW(context.check_errors("a test"), Error);
  EXPECT_NO_THROW(context.check_errors("a test"));
}

TEST(Context, ManyLiveOneAfterAnother) {
  for (int i = 0; i < 3; ++i) EXPECT_NO_THROW(Context().check_errors("nothing"));
}

TEST(Program, SaysFileAndLineOfAnError) {
  Context context;
  try {  // SIDE and answer() are missing
    make_screen_program("broken", {0, {"gpu/shaders/probe/probe.frag.glsl"}, {}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("gpu/shaders/probe/probe.frag.glsl:3: "), std::string::npos)
        << error.what();
  }
}

TEST(Program, ComesFromTheCacheTheSecondTime) {
  Context context;
  GLint formats = 0;
  glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
  if (formats == 0) GTEST_SKIP() << "this driver gives out no program binaries";
  const std::string folder = testing::TempDir() + "rayengine-cache-" + std::to_string(::getpid());
  setenv("XDG_CACHE_HOME", folder.c_str(), 1);
  const Stage stage{0, {"gpu/shaders/probe/early.frag.glsl"}, {}};
  EXPECT_FALSE(make_screen_program("first", stage).cached());
  EXPECT_TRUE(make_screen_program("second", stage).cached());
  unsetenv("XDG_CACHE_HOME");
}
