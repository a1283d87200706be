// What the stream tracer costs on this machine's GPU, as CSV. Lines with # say on what.
// Usage: stream_bench passes SCENE [K]      a pass of the loop against the share of rays that are not done
//        stream_bench loop SCENE [K...]     rays/s and tests/s against K, traffic and memory
// On a rasterizer in software seconds are those of the processor, over all its cores: other work disturbs them less.

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <random>

#include "accel/stopwatch.h"
#include "accel/tracer.h"
#include "accel/walk.h"
#include "engine/load/load.h"
#include "engine/measure/rays.h"
#include "gpu/stream/stream_engine.h"
#include "gpu/stream/stream_tracer.h"

namespace rayengine {
namespace {

constexpr GLsizei side = 512;
constexpr std::size_t ray_count = static_cast<std::size_t>(side) * side;
constexpr int runs = 9;

double now(bool software) {
  if (software) return processor_seconds();
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class Work>
double seconds(bool software, const Work& work) {
  const double start = now(software);
  work();
  return now(software) - start;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Medians of several runs of what tells its seconds, taken in turns, so that what the machine does meanwhile strikes
/// all alike.
std::vector<double> in_turns(const std::vector<std::function<double()>>& works) {
  std::vector<std::vector<double>> times(works.size());
  for (int run = -1; run < runs; ++run)  // one to warm up
    for (std::size_t i = 0; i < works.size(); ++i) {
      const double time = works[i]();
      if (run >= 0) times[i].push_back(time);
    }
  std::vector<double> medians;
  for (auto& t : times) medians.push_back(median(std::move(t)));
  return medians;
}

std::vector<Ray> rays_of(Scene& scene) {
  scene.camera.size = {side, side};
  return primary_rays(scene.camera);
}

/// A batch that can be run on chosen treelets, without the tracer around it.
class Passes {
 public:
  Passes(const Geometry& geometry, std::span<const Ray> rays, std::uint32_t K)
      : scene_{std::make_shared<Geometry>(geometry), std::vector<std::uint32_t>(geometry.triangles.size()),
               std::vector<std::uint32_t>(geometry.quadrics.size())},
        treelets_(build_treelets(treelet_primitives(geometry), K, frame_bounds(geometry))),
        textures_(upload(scene_, treelets_, context_.info())),
        kernels_(textures_, StreamQuery::closest, {}) {
    const auto& all = treelets_.treelets;
    const auto smaller = [](const Treelet& a, const Treelet& b) { return a.size() < b.size(); };
    const auto [least, most] = std::minmax_element(all.begin(), all.end(), smaller);
    smallest_ = static_cast<std::uint32_t>(least - all.begin());
    largest_ = static_cast<std::uint32_t>(most - all.begin());
    for (std::size_t i = 0; i < ray_count; ++i) {
      const FrameRay ray = in_frame(treelets_.frame, rays[i]);
      const std::size_t place = batch_.place(i);
      batch_.origins()[place] = {ray.origin, ray.tmin};
      batch_.directions()[place] = {ray.direction, ray.tmax};
      batch_.entries()[place] = glm::uvec2(no_id, pack_entries({0, 0}));
    }
  }

  const GpuInfo& gpu() const { return context_.info(); }
  std::size_t primitives() const { return treelets_.treelets[largest_].size(); }

  /// Seconds of the kernel alone: one pass in which all rays are tested against the largest treelet.
  double kernel_alone() {
    set_lists([this](std::size_t) { return glm::uvec4(largest_, no_id, no_id, no_id); });
    return run(1);
  }

  /// Seconds of the last pass of the loop when this share of the rays (at least one) is left: side by side, as the
  /// tracer sorts them, or anywhere. The passes before it have next to nothing to test, and are taken off.
  double pass(double share, bool scattered) {
    std::mt19937 random(2);
    std::bernoulli_distribution chosen(share);
    const glm::uvec4 left(smallest_, smallest_, largest_, no_id), done(smallest_, no_id, no_id, no_id);
    set_lists([&](std::size_t i) {
      return i == 0 || (scattered ? chosen(random) : static_cast<double>(i) < share * ray_count) ? left : done;
    });
    const double before = run(2);
    return run(3) - before;
  }

 private:
  template <class List>
  void set_lists(const List& list) {
    for (std::size_t i = 0; i < ray_count; ++i) batch_.lists()[batch_.place(i)] = list(i);
  }

  double run(std::uint32_t rounds) {
    batch_.upload(ray_count);
    glFinish();
    return seconds(gpu().software, [&] {
      kernels_.run(batch_, textures_, rounds);
      glFinish();
    });
  }

  Context context_;
  FlatScene scene_;
  Treelets treelets_;
  SceneTextures textures_;
  StreamKernels kernels_;
  StreamBatch batch_{side};
  std::uint32_t smallest_ = 0, largest_ = 0;  // treelets
};

void say_what(const char* file, const Geometry& geometry, const GpuInfo& gpu) {
  std::printf("# %s: %zu triangles, %zu quadrics; %d x %d rays; %s, seconds of the %s\n", file,
              geometry.triangles.size(), geometry.quadrics.size(), side, side, gpu.renderer.c_str(),
              gpu.software ? "processor" : "clock");
}

void measure_passes(const char* file, std::uint32_t K) {
  Scene scene = load_scene(file);
  Passes passes(*scene.geometry, rays_of(scene), K);
  say_what(file, *scene.geometry, passes.gpu());
  std::printf("# every ray that is left is tested against %zu primitives\n", passes.primitives());
  constexpr std::array shares{0., .01, .02, .05, .1, .15, .25, .35, .5, .65, .75, .9, 1.};
  std::array<std::vector<double>, 2 * shares.size()> costs;
  const auto measure = [&](std::size_t i) { costs[i].push_back(passes.pass(shares[i / 2], i % 2)); };
  for (int run = 0; run < runs; ++run)
    for (std::size_t i = 0; i < costs.size(); ++i) measure(i);
  for (int run = 0; run < 10 * runs; ++run) measure(0), measure(1);  // next to nothing needs more care
  const double full = median(costs[costs.size() - 2]);
  std::printf("share_left,ms,share_of_full,scattered_ms,scattered_share_of_full\n");
  for (std::size_t i = 0; i < costs.size(); i += 2) {
    const double sorted = median(costs[i]), scattered = median(costs[i + 1]);
    std::printf("%.2f,%.3f,%.4f,%.3f,%.4f\n", shares[i / 2], 1e3 * sorted, sorted / full, 1e3 * scattered,
                scattered / full);
  }
}

/// Tests that the loop makes: all of every treelet that a ray enters before its nearest hit.
std::size_t tests_made(const Geometry& geometry, std::span<const Ray> rays, std::span<const Hit> hits,
                       std::uint32_t K) {
  const Treelets treelets = build_treelets(treelet_primitives(geometry), K, frame_bounds(geometry));
  std::size_t tests = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Ray ray = rays[i];
    if (hits[i].hit()) ray.tmax = hits[i].t;
    tests += treelets.unbounded.size();
    for (WalkCursor cursor; !cursor.finished();) {
      std::array<TreeletEntry, 8> list;
      std::uint32_t count = 0;
      walk(treelets, {&ray, 1}, {&cursor, 1}, 8, list, {&count, 1});
      for (std::uint32_t k = 0; k < count; ++k) tests += treelets.treelets[list[k].treelet].size();
    }
  }
  return tests;
}

/// The stream tracer at one K, beside its kernel alone on the same primitives.
void measure_loop(const Geometry& geometry, std::span<const Ray> rays, const char* rays_name, std::uint32_t K) {
  StreamOptions options;
  options.treelet_size = K;
  const auto shared = std::make_shared<Geometry>(geometry);
  const auto tracer = make_stream_tracer(shared, Precision::fast, options);
  std::vector<Hit> hits(rays.size());
  Passes alone(geometry, rays, K);
  const std::vector<double> times =
      in_turns({[&] { return seconds(alone.gpu().software, [&] { tracer->closest(rays, hits, RayClass::primary); }); },
                [&] { return alone.kernel_alone(); }});
  const double tests = static_cast<double>(tests_made(geometry, rays, hits, K)) / times[0];
  const double kernel = static_cast<double>(alone.primitives() * ray_count) / times[1];

  StreamEngine engine(shared, options);
  engine.trace(rays, StreamQuery::closest, [](const Traveller&) { return DeviceEngine::Next::done; });
  std::printf("%s,%u,%.4f,%.3f,%.3f,%.4f,%.1f,%.1f\n", rays_name, K, static_cast<double>(rays.size()) / times[0] * 1e-6,
              tests * 1e-6, kernel * 1e-6, tests / kernel,
              static_cast<double>(engine.bytes_carried()) / static_cast<double>(rays.size()),
              static_cast<double>(engine.scene_bytes()) /
                  static_cast<double>(geometry.triangles.size() + geometry.quadrics.size()));
}

void measure_loops(const char* file, std::vector<std::uint32_t> sizes) {
  Scene scene = load_scene(file);
  const std::vector<Ray> primary = rays_of(scene), random = random_rays(scene.geometry->bounds, ray_count);
  say_what(file, *scene.geometry, Context().info());
  std::printf(
      "rays,K,Mrays_per_s,Mtests_per_s,kernel_alone_Mtests_per_s,share_of_kernel_alone,bytes_a_ray,"
      "device_bytes_a_primitive\n");
  for (const std::uint32_t K : sizes) {
    measure_loop(*scene.geometry, primary, "primary", K);
    measure_loop(*scene.geometry, random, "random", K);
  }
}

}  // namespace
}  // namespace rayengine

int main(int argc, char** argv) {
  using namespace rayengine;
  std::vector<std::uint32_t> sizes;
  for (int i = 3; i < argc; ++i) sizes.push_back(static_cast<std::uint32_t>(std::atoi(argv[i])));
  const bool passes = argc > 2 && std::strcmp(argv[1], "passes") == 0;
  if (!passes && !(argc > 2 && std::strcmp(argv[1], "loop") == 0)) {
    std::fprintf(stderr, "usage: stream_bench passes SCENE [K] | stream_bench loop SCENE [K...]\n");
    return 2;
  }
  try {
    if (passes)
      measure_passes(argv[2], sizes.empty() ? 256 : sizes.front());
    else
      measure_loops(argv[2], sizes.empty() ? std::vector<std::uint32_t>{8, 16, 32, 64, 128, 256, 512, 1024} : sizes);
  } catch (const Error& error) {
    std::fprintf(stderr, "stream_bench: %s\n", error.what());
    return 1;
  }
}
