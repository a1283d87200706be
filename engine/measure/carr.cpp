#include "engine/measure/carr.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "accel/random.h"
#include "accel/stopwatch.h"
#include "accel/walk.h"
#include "engine/measure/race.h"
#include "engine/measure/rays.h"
#include "engine/query.h"
#include "engine/tracers.h"
#include "gpu/stream/stream_tracer.h"

namespace rayengine {
namespace {

constexpr glm::ivec2 picture{512, 512};
constexpr std::uint32_t treelet_size = 512;  // what suits a GPU: see docs/performance.md
constexpr std::uint32_t list_length = 4;
constexpr std::size_t block = 256;

/// The processor's part of the ray engine. A ray goes on until its recorded hit lies before the next treelet, as it
/// would when a GPU had just found it.
class InfinitelyFastGpu {
 public:
  explicit InfinitelyFastGpu(const Geometry& geometry)
      : treelets_(build_treelets(treelet_primitives(geometry), treelet_size, frame_bounds(geometry))) {}

  void answer(std::span<const Ray> rays, std::span<const Hit> recorded, std::span<Hit> hits) const {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rays.size(), block), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); i += block) {
        const std::size_t count = std::min(block, range.end() - i);
        answer_block(rays.subspan(i, count), recorded.subspan(i, count), hits.subspan(i, count));
      }
    });
  }

 private:
  void answer_block(std::span<const Ray> rays, std::span<const Hit> recorded, std::span<Hit> hits) const {
    std::array<Ray, block> on_their_way;
    std::array<WalkCursor, block> cursors;
    std::array<std::uint32_t, block> places, counts;
    std::array<TreeletEntry, block * list_length> lists;
    std::size_t left = rays.size();
    for (std::uint32_t i = 0; i < left; ++i) on_their_way[i] = rays[i], cursors[i] = {}, places[i] = i;
    while (left > 0) {
      walk(treelets_, {on_their_way.data(), left}, {cursors.data(), left}, list_length, lists, counts);
      std::size_t kept = 0;
      for (std::size_t i = 0; i < left; ++i) {
        const Hit& hit = recorded[places[i]];
        const bool passed = counts[i] > 0 && hit.t < lists[i * list_length + counts[i] - 1].t;
        if (cursors[i].finished() || passed) {
          hits[places[i]] = hit;
          continue;
        }
        on_their_way[kept] = on_their_way[i], cursors[kept] = cursors[i], places[kept++] = places[i];
      }
      left = kept;
    }
  }

  Treelets treelets_;
};

struct Rays {
  std::vector<Ray> primary, bounce;
  std::vector<Hit> primary_hits, bounce_hits;  ///< recorded

  std::size_t count() const { return primary.size() + bounce.size(); }
};

Rays make_rays(const Scene& scene, Tracer& tracer) {
  Rays rays;
  Camera camera = scene.camera;
  camera.size = picture;
  rays.primary = primary_rays(camera);
  rays.primary_hits.resize(rays.primary.size());
  closest(tracer, rays.primary, rays.primary_hits, RayClass::primary);
  rays.bounce = bounce_rays(*scene.geometry, rays.primary, rays.primary_hits);
  rays.bounce_hits.resize(rays.bounce.size());
  closest(tracer, rays.bounce, rays.bounce_hits, RayClass::bounce);
  return rays;
}

double seconds_of(const std::function<void()>& work) {
  const Stopwatch watch;
  work();
  return watch.seconds();
}

Scene looked_at(GeometryBuilder& builder) {
  Scene scene;
  scene.geometry = builder.build();
  scene.materials = {{}};
  scene.camera = {.from = {0, -3.5, 1}, .at = {0, 0, 0}, .up = {0, 0, 1}, .fov = 45, .size = picture};
  return scene;
}

struct Contender {
  std::string row;
  std::function<void()> answer;
  std::vector<double> seconds;
};

}  // namespace

std::vector<CarrRow> carr(const Scene& scene, const std::string& name, const CarrOptions& options) {
  const auto cpu = make_tracer("embree", scene.geometry, {.threads = options.threads});
  const auto stream = [&](int in_flight) {
    return make_stream_tracer(scene.geometry, Precision::robust, {.device = options.gpu, .in_flight = in_flight});
  };
  const auto synchronous = stream(1), asynchronous = stream(3);
  const InfinitelyFastGpu infinite(*scene.geometry);
  const Rays rays = make_rays(scene, *cpu);
  std::vector<Hit> hits(std::max(rays.primary.size(), rays.bounce.size()));
  const auto by = [&](Tracer& tracer) {
    return [&] {
      closest(tracer, rays.primary, std::span(hits).first(rays.primary.size()), RayClass::primary);
      closest(tracer, rays.bounce, std::span(hits).first(rays.bounce.size()), RayClass::bounce);
    };
  };
  std::array<Contender, 4> contenders = {{{"CPU alone", by(*cpu), {}},
                                          {"GPU, synchronous read-back", by(*synchronous), {}},
                                          {"GPU, asynchronous read-back", by(*asynchronous), {}},
                                          {"infinitely fast GPU",
                                           [&] {
                                             infinite.answer(rays.primary, rays.primary_hits, hits);
                                             infinite.answer(rays.bounce, rays.bounce_hits, hits);
                                           },
                                           {}}}};
  for (int run = 0; run <= timed_runs; ++run) {  // the first warms up
    for (Contender& c : contenders)
      if (const double seconds = seconds_of(c.answer); run > 0) c.seconds.push_back(seconds);
    if (options.progress) options.progress(static_cast<double>(run + 1) / (timed_runs + 1));
  }
  std::vector<CarrRow> rows;
  for (Contender& c : contenders) {
    std::ranges::sort(c.seconds);
    rows.push_back({c.row, name, static_cast<double>(rays.count()) / c.seconds[timed_runs / 2]});
  }
  return rows;
}

Scene many_balls() {
  GeometryBuilder builder;
  for (std::uint64_t i = 0; i < 8000; ++i) {
    Random random(1, i);
    const glm::dvec3 center(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    builder.add(QuadricShape{}, 0, Affine::translate(center) * Affine::scale(glm::dvec3(0.03)));
  }
  return looked_at(builder);
}

Scene large_mesh() {
  constexpr int rings = 250, sides = 400;
  Mesh mesh;
  for (int r = 0; r <= rings; ++r)
    for (int s = 0; s < sides; ++s) {
      const double polar = std::numbers::pi * r / rings, around = 2 * std::numbers::pi * s / sides;
      const double radius = 1 + 0.15 * std::sin(9 * polar) * std::sin(12 * around);
      mesh.positions.emplace_back(radius * std::sin(polar) * std::cos(around),
                                  radius * std::sin(polar) * std::sin(around), radius * std::cos(polar));
    }
  for (std::uint32_t r = 0; r < rings; ++r)
    for (std::uint32_t s = 0; s < sides; ++s) {
      const std::uint32_t a = r * sides + s, b = r * sides + (s + 1) % sides;
      mesh.triangles.push_back({a, a + sides, b});
      mesh.triangles.push_back({b, a + sides, b + sides});
    }
  GeometryBuilder builder;
  builder.add(std::move(mesh));
  return looked_at(builder);
}

}  // namespace rayengine
