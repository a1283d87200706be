// What can go wrong with a device becomes one Error. Where this machine cannot be made to fail, the library that loads
// OpenGL is given another function to call: it keeps them in variables.

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <string>

#include "gpu/objects/objects_tracer.h"
#include "gpu/scene/scene_textures.h"
#include "gpu/stream/stream_tracer.h"
#include "tests/gpu/instead.h"

namespace rayengine {
namespace {

using test::Instead;

std::shared_ptr<const Geometry> sphere() {
  GeometryBuilder builder;
  builder.add(QuadricShape{});
  return builder.build();
}

std::vector<Ray> one_ray() { return {Ray{{0, 0, -5}, 0, {0, 0, 1}, infinity}}; }

/// What `work` complains of: one line.
template <class Work>
std::string complaint(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    return text;
  }
  return "nothing";
}

bool says(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

using MakeLost = std::unique_ptr<Tracer> (*)();
class LostDevice : public testing::TestWithParam<MakeLost> {
 protected:
  std::string complaint_of_query() {
    return complaint([this] {
      std::vector<Hit> hits(1);
      tracer->closest(one_ray(), hits, RayClass::primary);
    });
  }
  std::unique_ptr<Tracer> tracer = GetParam()();
};
INSTANTIATE_TEST_SUITE_P(Tracers, LostDevice,
                         testing::Values(
                             +[] { return make_stream_tracer(sphere(), Precision::robust); },
                             +[] { return make_objects_tracer(sphere(), Precision::robust); },
                             +[] { return make_objects_tracer(sphere(), Precision::half); }));

TEST_P(LostDevice, IsAnErrorOfTheQueryAndOfNoOther) {
  ASSERT_EQ(complaint_of_query(), "nothing");
  {
    const Instead reset(
        glGetGraphicsResetStatus, +[]() -> GLenum { return GL_GUILTY_CONTEXT_RESET; });
    EXPECT_TRUE(says(complaint_of_query(), "GL_CONTEXT_LOST; use --tracer embree"));
  }
  EXPECT_EQ(complaint_of_query(), "nothing");
}

TEST_P(LostDevice, IsNoticedWhileWaiting) {
  ASSERT_EQ(complaint_of_query(), "nothing");
  const Instead wait(
      glClientWaitSync, +[](GLsync, GLbitfield, GLuint64) -> GLenum { return GL_WAIT_FAILED; });
  EXPECT_TRUE(says(complaint_of_query(), "was lost"));
}

TEST_P(LostDevice, OneThatNeverAnswersIsGivenUp) {
  ASSERT_EQ(complaint_of_query(), "nothing");
  const Instead wait(
      glClientWaitSync, +[](GLsync, GLbitfield, GLuint64) -> GLenum { return GL_TIMEOUT_EXPIRED; });
  EXPECT_TRUE(says(complaint_of_query(), "has not answered for a minute"));
}

TEST(Faults, AShaderThatDoesNotCompileIsNamedWithItsLine) {
  StreamOptions options;
  options.defines = {"consider=consider ("};
  const std::string text = complaint([&] { make_stream_tracer(sphere(), Precision::robust, options); });
  EXPECT_TRUE(says(text, "does not compile the program sphere: gpu/shaders/stream/consider.glsl:")) << text;
}

TEST(Faults, ASceneLargerThanTheTexturesIsRefused) {
  const FlatScene scene = flatten(sphere());
  const Treelets treelets = build_treelets(treelet_primitives(*scene.geometry), 8);
  GpuInfo gpu;
  gpu.buffer_texels = 3;  // a quadric takes four
  EXPECT_TRUE(says(complaint([&] { upload(scene, treelets, gpu); }),
                   "quadrics need 4 texels, more than the GPU's 3; use --tracer embree"));
}

TEST(Faults, InstancesThatWouldFillTheMemoryAreRefused) {
  GeometryBuilder builder;
  for (int i = 0; i < 3; ++i) builder.add(sphere());
  EXPECT_TRUE(says(complaint([&] { flatten(builder.build(), 2); }), "use --tracer embree"));
}

TEST(Faults, MemoryThatTheDeviceDoesNotHaveIsAnError) {
  constexpr std::size_t too_much = std::size_t{1} << 46;
  Context context;
  EXPECT_TRUE(says(complaint([&] { make_mapped_buffer(too_much, Mapping::upload); }), "cannot map a buffer"));
  const std::string text = complaint([&] { context.check_errors("a test"); });
  EXPECT_TRUE(says(text, "failed during a test: GL_OUT_OF_MEMORY")) << text;
}

TEST(Faults, ABatchThatTheDeviceHasNoMemoryForIsAnErrorOfTheQuery) {
  const auto tracer = make_stream_tracer(sphere(), Precision::robust);
  const Instead storage(
      glNamedBufferStorage, +[](GLuint, GLsizeiptr, const void*, GLbitfield) {});
  std::vector<Hit> hits(1);
  EXPECT_TRUE(says(complaint([&] { tracer->closest(one_ray(), hits, RayClass::primary); }), "cannot map a buffer"));
}

}  // namespace
}  // namespace rayengine
