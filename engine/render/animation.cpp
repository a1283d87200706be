#include "engine/render/animation.h"

#include <atomic>
#include <future>
#include <glm/geometric.hpp>

#include "accel/stopwatch.h"
#include "accel/transform.h"

namespace rayengine {
namespace {

/// Share of a frame after which the next one begins.
constexpr double nearly_done = 0.9;

void add(RenderStats& sum, const RenderStats& frame) {
  for (std::size_t i = 0; i < sum.rays.size(); ++i) sum.rays[i] += frame.rays[i];
  sum.tracer_seconds += frame.tracer_seconds;
  sum.shading_seconds += frame.shading_seconds;
  sum.invalid_rays += frame.invalid_rays;
  sum.photon_rays += frame.photon_rays;
}

/// Lets whoever waits for a frame go on, once: when it is nearly done, or has failed.
class Starter {
 public:
  void go() {
    if (!gone_.exchange(true)) promise_.set_value();
  }
  void wait() { promise_.get_future().wait(); }

 private:
  std::promise<void> promise_;
  std::atomic<bool> gone_ = false;
};

}  // namespace

Camera turntable(const Camera& camera, int frame, int frames) {
  if (frame == 0) return camera;
  Camera turned = camera;
  turned.from = camera.at + Affine::rotate(camera.up, 360.0 * frame / frames).vector(camera.from - camera.at);
  return turned;
}

RenderStats render_turn(const Scene& scene, Tracer& tracer, const RenderOptions& options, int frames,
                        const FrameDone& done) {
  const Stopwatch watch;
  RenderStats sum;
  const auto render_frame = [&](int frame, Starter& next) {
    Scene turned = scene;
    turned.camera = turntable(scene.camera, frame, frames);
    RenderOptions here = options;
    here.progress = [&](double share) {
      if (share >= nearly_done) next.go();
      if (options.progress) options.progress((frame + share) / frames);
    };
    return render(turned, tracer, here);
  };
  std::atomic<bool> failed = false;
  std::future<void> last;
  for (int frame = 0; frame < frames && !failed; ++frame) {
    const auto next = std::make_shared<Starter>();
    last = std::async(std::launch::async, [&, frame, next, before = last.share()] {
      try {
        RenderResult result = render_frame(frame, *next);
        next->go();
        if (before.valid()) before.get();
        add(sum, result.stats);
        done(frame, result);
      } catch (...) {
        failed = true;
        next->go();
        throw;
      }
    });
    next->wait();
  }
  if (last.valid()) last.get();
  sum.seconds = watch.seconds();
  return sum;
}

}  // namespace rayengine
