// A real GPU tracer under the hybrid loses its context in the middle of the work. Where this machine's driver cannot be
// made to do so, it is given other functions to call.

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <optional>

#include "engine/hybrid/hybrid_tracer.h"
#include "engine/measure/rays.h"
#include "gpu/stream/stream_tracer.h"
#include "tests/gpu/instead.h"
#include "tests/unit/fake_gpu.h"
#include "tests/unit/render_scenes.h"

namespace rayengine::test {
namespace {

std::atomic<int> calls_left;  ///< until the context is lost
bool lost() { return --calls_left < 0; }

/// How a context is lost: which function tells, and from which of its calls on.
enum class Loss { reset, wait_fails, taken_away };
constexpr int never = 1'000'000;
struct Case {
  Loss loss;
  int calls;
};

decltype(glGetGraphicsResetStatus) true_status;
decltype(glClientWaitSync) true_wait;

GLenum status_of_reset() { return lost() ? GL_GUILTY_CONTEXT_RESET : true_status(); }
GLenum failing_wait(GLsync sync, GLbitfield flags, GLuint64 timeout) {
  return lost() ? GL_WAIT_FAILED : true_wait(sync, flags, timeout);
}
/// The thread really has no context any more.
GLenum wait_without_context(GLsync sync, GLbitfield flags, GLuint64 timeout) {
  if (lost()) eglMakeCurrent(eglGetCurrentDisplay(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  return true_wait(sync, flags, timeout);
}

Scene balls() {
  GeometryBuilder builder;
  for (int i = 0; i < 27; ++i)
    builder.add(unit_sphere, 0, Affine::translate({3. * (i % 3), 3. * (i / 3 % 3), 3. * (i / 9)}));
  Scene scene = scene_of(builder, {.color = {1, 0.8f, 0.6f}, .reflect = 0.4f},
                         {.from = {3, -14, 8}, .at = {3, 3, 3}, .up = {0, 0, 1}, .fov = 45, .size = {160, 120}});
  scene.lights = {point_light({10, -10, 20})};
  return scene;
}

/// A processor so slow that the GPU pays, even one in software under a sanitizer, and the stream tracer on whatever GPU
/// there is.
class LostContext : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    const auto stream = make_stream_tracer(scene.geometry, Precision::robust);  // puts OpenGL's functions in place
    std::vector<Hit> hits(rays.size());
    stream->closest(rays, hits, RayClass::primary);
    true_status = glGetGraphicsResetStatus, true_wait = glClientWaitSync;
    calls_left = never;
    const Loss loss = GetParam().loss;
    status.emplace(glGetGraphicsResetStatus, loss == Loss::reset ? status_of_reset : true_status);
    wait.emplace(glClientWaitSync, loss == Loss::wait_fails   ? failing_wait
                                   : loss == Loss::taken_away ? wait_without_context
                                                              : true_wait);
    hybrid = make_hybrid_tracer(std::make_unique<PacedTracer>(scene.geometry, 0, 3e-5, true),
                                [this] { return make_stream_tracer(scene.geometry, Precision::robust); },
                                {.threads = 2, .say = [this](const std::string& text) {
                                   const std::lock_guard lock(mutex);
                                   said.push_back(text);
                                 }});
    calls_left = GetParam().calls;
  }

  /// A busy machine may be done before the GPU is asked: then there must be more to do.
  bool go_on(int done) const { return done < 3 || (done < 20 && GetParam().calls != never && calls_left >= 0); }

  /// That it was lost in the middle of the work, and said so in one line; or else that the GPU took part.
  void expect_loss() {
    const std::lock_guard lock(mutex);
    if (GetParam().calls == never) {
      EXPECT_TRUE(said.empty());
      EXPECT_LT(calls_left, never);
      return;
    }
    EXPECT_LT(calls_left, 0);
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("the GPU failed"), std::string::npos) << said[0];
    EXPECT_NE(said[0].find("the processor goes on alone"), std::string::npos) << said[0];
    EXPECT_EQ(said[0].find('\n'), std::string::npos) << said[0];
  }

  const Scene scene = balls();
  const std::vector<Ray> rays = random_rays(scene.geometry->bounds, 20'000, 5);
  std::optional<Instead<decltype(glGetGraphicsResetStatus)>> status;
  std::optional<Instead<decltype(glClientWaitSync)>> wait;
  std::mutex mutex;
  std::vector<std::string> said;
  std::unique_ptr<Hybrid> hybrid;  // first to go
};
// With the first batch or the second: whether more are sent is for the trial to say.
INSTANTIATE_TEST_SUITE_P(Faults, LostContext,
                         testing::Values(Case{Loss::reset, never}, Case{Loss::reset, 0}, Case{Loss::reset, 1},
                                         Case{Loss::wait_fails, 0}, Case{Loss::wait_fails, 3},
                                         Case{Loss::taken_away, 0}, Case{Loss::taken_away, 3}));

TEST_P(LostContext, EveryRayIsAnsweredOnce) {
  std::vector<Hit> right(rays.size());
  make_embree_tracer(scene.geometry, Precision::robust)->closest(rays, right, RayClass::primary);
  std::size_t queries = 0;
  for (; go_on(static_cast<int>(queries)); ++queries) {
    std::vector<Hit> hits(rays.size());
    for (Hit& hit : hits) hit.status = 77;  // nobody's answer
    hybrid->closest(rays, hits, RayClass::primary);
    int wrong = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
      wrong += hits[i].object != right[i].object || hits[i].primitive != right[i].primitive ||
               hits[i].status != right[i].status || hits[i].t != right[i].t;
    EXPECT_EQ(wrong, 0) << "query " << queries;
  }
  const HybridReport report = hybrid->report();
  EXPECT_EQ(report.cpu_rays + report.gpu_rays, queries * rays.size());
  expect_loss();
}

class RenderInvarianceLostContext : public LostContext {};
INSTANTIATE_TEST_SUITE_P(Faults, RenderInvarianceLostContext,
                         testing::Values(Case{Loss::reset, 0}, Case{Loss::wait_fails, 0}, Case{Loss::taken_away, 0}));

TEST_P(RenderInvarianceLostContext, LeavesThePictureAsItIs) {
  const RenderOptions options{.depth = 3, .threads = 2};
  const Image right = render_with("embree", scene, options).image;
  for (int picture = 0; go_on(picture); ++picture)
    EXPECT_EQ(render(scene, *hybrid, options).image.pixels, right.pixels) << "picture " << picture;
  expect_loss();
}

}  // namespace
}  // namespace rayengine::test
