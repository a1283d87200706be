// What the passes of the stream tracer cost on this machine's GPU: a pass against the share of rays alive, tests/s of a
// kernel alone and inside the loop, and rays/s against K.
// Usage: stream_bench [MESH [K...]]    (without a mesh: 7,381 spheres)

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <glm/geometric.hpp>
#include <random>

#include "accel/tracer.h"
#include "accel/walk.h"
#include "engine/load/load.h"
#include "engine/measure/rays.h"
#include "gpu/stream_kernels.h"
#include "gpu/stream_tracer.h"

namespace rayengine {
namespace {

constexpr GLsizei side = 512;
constexpr std::size_t ray_count = static_cast<std::size_t>(side) * side;

/// On a rasterizer in software the processor's time, which other work on the machine disturbs less.
double now(bool software) {
  if (software) return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The median of five runs.
double seconds(bool software, const std::function<void()>& work) {
  std::vector<double> times(5);
  for (double& time : times) {
    const double start = now(software);
    work();
    time = now(software) - start;
  }
  std::nth_element(times.begin(), times.begin() + 2, times.end());
  return times[2];
}

std::shared_ptr<const Geometry> spheres() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-1, 1);
  GeometryBuilder builder;
  for (int i = 0; i < 7381; ++i)
    builder.add(QuadricShape{}, 0,
                Affine::translate({place(random), place(random), place(random)}) * Affine::scale(glm::dvec3(.02)));
  return builder.build();
}

std::vector<Ray> rays_at(const Geometry& geometry) {
  Camera camera;
  camera.at = geometry.bounds.center();
  camera.from = camera.at + glm::dvec3(0, -1.6, .8) * glm::length(geometry.bounds.size());
  camera.size = {side, side};
  return primary_rays(camera);
}

/// A batch whose rays all take one treelet along, or none.
class OneTreelet {
 public:
  OneTreelet(const Geometry& geometry, std::uint32_t K)
      : scene_{std::make_shared<Geometry>(geometry), std::vector<std::uint32_t>(geometry.triangles.size()),
               std::vector<std::uint32_t>(geometry.quadrics.size())},
        treelets_(build_treelets(treelet_primitives(geometry), K)),
        textures_(upload(scene_, treelets_, context_.info())),
        kernels_(textures_, StreamQuery::closest, {}) {
    const auto larger = [](const Treelet& a, const Treelet& b) { return a.size() < b.size(); };
    largest_ =
        std::max_element(treelets_.treelets.begin(), treelets_.treelets.end(), larger) - treelets_.treelets.begin();
    const std::vector<Ray> rays = rays_at(geometry);
    for (std::size_t i = 0; i < ray_count; ++i) {
      const FrameRay ray = in_frame(treelets_.frame, rays[i]);
      batch_.origins()[i] = {ray.origin, ray.tmin};
      batch_.directions()[i] = {ray.direction, ray.tmax};
      batch_.entries()[i] = glm::uvec4(no_id, 0, 0, 0);
    }
  }

  std::size_t tests() const { return treelets_.treelets[static_cast<std::size_t>(largest_)].size(); }
  const GpuInfo& gpu() const { return context_.info(); }

  /// Seconds for the two passes when this share of the rays takes part: side by side, as the tracer sorts them, or
  /// anywhere.
  double cost(double alive, bool scattered = false) {
    std::mt19937 random(2);
    std::bernoulli_distribution chosen(alive);
    const auto lists = batch_.lists();
    for (std::size_t i = 0; i < ray_count; ++i) {
      const bool takes_part = scattered ? chosen(random) : static_cast<double>(i) < alive * ray_count;
      lists[i] = glm::uvec4(takes_part ? largest_ : no_id, no_id, no_id, no_id);
    }
    batch_.upload(ray_count);
    glFinish();
    return seconds(gpu().software, [&] {
      kernels_.run(batch_, textures_, 1);
      glFinish();
    });
  }

 private:
  Context context_;
  FlatScene scene_;
  Treelets treelets_;
  SceneTextures textures_;
  StreamKernels kernels_;
  StreamBatch batch_{side};
  std::ptrdiff_t largest_ = 0;
};

/// Tests that the loop makes: all of every treelet that a ray enters before its nearest hit.
std::size_t tests_made(const Geometry& geometry, std::span<const Ray> rays, std::span<const Hit> hits,
                       std::uint32_t K) {
  const Treelets treelets = build_treelets(treelet_primitives(geometry), K);
  std::size_t tests = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Ray ray = rays[i];
    if (hits[i].hit()) ray.tmax = hits[i].t;
    for (WalkCursor cursor; !cursor.finished();) {
      std::array<TreeletEntry, 8> list;
      std::uint32_t count = 0;
      walk(treelets, {&ray, 1}, {&cursor, 1}, 8, list, {&count, 1});
      for (std::uint32_t k = 0; k < count; ++k) tests += treelets.treelets[list[k].treelet].size();
    }
  }
  return tests;
}

void run(const Geometry& geometry, std::vector<std::uint32_t> sizes) {
  double alone = 0;
  bool software = false;
  {
    OneTreelet one(geometry, 256);
    software = one.gpu().software;
    if (software) std::printf("seconds are those of the processor, over all its cores\n");
    std::printf("%s, %d x %d rays, one treelet of %zu primitives\n", one.gpu().renderer.c_str(), side, side,
                one.tests());
    const double full = one.cost(1);
    alone = static_cast<double>(one.tests() * ray_count) / full;
    for (const double share : {0., .01, .05, .1, .25, .5, .75, 1.}) {
      const double cost = one.cost(share), scattered = one.cost(share, true);
      std::printf("  %5.0f %% alive: %8.2f ms, %5.1f %% of a full pass; scattered %8.2f ms, %5.1f %%\n", 100 * share,
                  1e3 * cost, 100 * cost / full, 1e3 * scattered, 100 * scattered / full);
    }
    std::printf("  kernel alone: %.1f Mtests/s\n", alone * 1e-6);
  }
  const std::vector<Ray> rays = rays_at(geometry);
  std::vector<Hit> hits(rays.size());
  for (const std::uint32_t K : sizes) {
    StreamOptions options;
    options.treelet_size = K;
    const auto tracer = make_stream_tracer(std::make_shared<Geometry>(geometry), Precision::fast, options);
    const double time = seconds(software, [&] { tracer->closest(rays, hits, RayClass::primary); });
    const double rate = static_cast<double>(tests_made(geometry, rays, hits, K)) / time;
    std::printf("  K %4u: %6.3f Mrays/s, %7.1f Mtests/s, %3.0f %% of the kernel alone\n", K, ray_count / time * 1e-6,
                rate * 1e-6, 100 * rate / alone);
  }
}

}  // namespace
}  // namespace rayengine

int main(int argc, char** argv) {
  using namespace rayengine;
  std::vector<std::uint32_t> sizes;
  for (int i = 2; i < argc; ++i) sizes.push_back(static_cast<std::uint32_t>(std::atoi(argv[i])));
  if (sizes.empty()) sizes = {8, 16, 32, 64, 128, 256, 512};
  try {
    run(argc > 1 ? *load_scene(argv[1]).geometry : *spheres(), sizes);
  } catch (const Error& error) {
    std::fprintf(stderr, "stream_bench: %s\n", error.what());
    return 1;
  }
}
