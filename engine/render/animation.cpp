#include "engine/render/animation.h"

#include <atomic>
#include <future>
#include <glm/geometric.hpp>

#include "accel/stopwatch.h"
#include "accel/transform.h"
#include "engine/render/camera.h"

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

void check(std::span<const Camera> cameras) {
  for (std::size_t frame = 0; frame < cameras.size(); ++frame) try {
      CameraFrame{cameras[frame]};
    } catch (const Error& error) {
      throw Error("in frame " + std::to_string(frame) + ", " + error.what());
    }
}

}  // namespace

std::vector<Camera> turntable(const Camera& camera, int frames) {
  std::vector<Camera> cameras(static_cast<std::size_t>(frames), camera);
  for (int frame = 1; frame < frames; ++frame)
    cameras[static_cast<std::size_t>(frame)].from =
        camera.at + Affine::rotate(camera.up, 360.0 * frame / frames).vector(camera.from - camera.at);
  return cameras;
}

RenderStats render_frames(const Scene& scene, std::span<const Camera> cameras, Tracer& tracer,
                          const RenderOptions& options, const FrameDone& done) {
  check(cameras);
  const int frames = static_cast<int>(cameras.size());
  const Stopwatch watch;
  RenderStats sum;
  const auto render_frame = [&](int frame, Starter& next) {
    Scene seen = scene;
    seen.camera = cameras[static_cast<std::size_t>(frame)];
    RenderOptions here = options;
    here.progress = [&](double share) {
      if (share >= nearly_done) next.go();
      if (options.progress) options.progress((frame + share) / frames);
    };
    return render(seen, tracer, here);
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
