// Where a picture's time goes: milliseconds of one thread's processor time in the tracer, by kind of ray, and outside
// it, the least of several renderings of 512x512, after one that has touched all memory. Usage: render_bench TRACER
// SCENE...

#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "accel/stopwatch.h"
#include "engine/load/load.h"
#include "engine/render/render.h"
#include "engine/tracers.h"

namespace {

using namespace rayengine;

constexpr int runs = 7;

struct Times {
  double primary = infinity, shadow = infinity, bounced = infinity, outside = infinity;

  void keep_least(const Times& t) {
    primary = std::min(primary, t.primary), shadow = std::min(shadow, t.shadow);
    bounced = std::min(bounced, t.bounced), outside = std::min(outside, t.outside);
  }
};

/// Passes queries on, and times them.
class Watched final : public Tracer {
 public:
  explicit Watched(Tracer& tracer) : tracer_(tracer) {}

  std::string_view name() const override { return tracer_.name(); }
  Precision precision() const override { return tracer_.precision(); }
  Limits limits() const override { return tracer_.limits(); }
  double build_seconds() const override { return tracer_.build_seconds(); }
  std::size_t bytes() const override { return tracer_.bytes(); }

  void closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) override {
    timed(ray_class == RayClass::primary ? times.primary : times.bounced,
          [&] { tracer_.closest(rays, hits, ray_class); });
  }
  void any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) override {
    timed(times.shadow, [&] { tracer_.any(rays, status, ray_class); });
  }
  HitLists all(std::span<const Ray> rays) override { return tracer_.all(rays); }

  Times times{0, 0, 0, 0};

 private:
  template <class Query>
  static void timed(double& seconds, const Query& query) {
    const double start = processor_seconds();
    query();
    seconds += processor_seconds() - start;
  }

  Tracer& tracer_;
};

Times measure(const Scene& scene, Tracer& tracer) {
  Times least;
  for (int run = -1; run < runs; ++run) {
    Watched watched(tracer);
    watched.times.outside = render(scene, watched, {.threads = 1}).stats.shading_seconds;
    if (run >= 0) least.keep_least(watched.times);
  }
  return least;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: render_bench TRACER SCENE...\n");
    return 2;
  }
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  std::printf("%-20s primary  shadow bounced outside  share of that\n", "ms");
  for (int i = 2; i < argc; ++i) try {
      Scene scene = load_scene(argv[i]);
      scene.camera.size = {512, 512};
      const Times t = measure(scene, *make_tracer(argv[1], scene.geometry, {.threads = 1}));
      std::printf("%-20s %7.1f %7.1f %7.1f %7.1f  %.0f %%\n", std::filesystem::path(argv[i]).stem().c_str(),
                  1e3 * t.primary, 1e3 * t.shadow, 1e3 * t.bounced, 1e3 * t.outside,
                  100 * t.outside / (t.primary + t.shadow + t.bounced + t.outside));
    } catch (const Error& error) {
      std::fprintf(stderr, "render_bench: %s\n", error.what());
      return 1;
    }
}
