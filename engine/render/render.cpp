#include "engine/render/render.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>

#include "accel/stopwatch.h"
#include "engine/render/aov.h"
#include "engine/render/photons.h"
#include "engine/render/tiles.h"

namespace rayengine {
namespace {

/// Pixels of the largest picture: those of a square of 16,384.
constexpr std::int64_t most_pixels = std::int64_t{1} << 28;
/// Waves of one depth wait for those of the next, so memory and stack grow with it.
constexpr int most_depth = 1000;
constexpr int most_photons = 1 << 26;  // 5 GB of them, all told
/// Tiles per thread at least, so that threads end together.
constexpr std::size_t tiles_per_thread = 8;

void check_materials(const Geometry& geometry, std::size_t count) {
  for (std::size_t i = 0; i < geometry.objects.size(); ++i)
    if (const Object& o = geometry.objects[i]; o.kind != Object::Kind::instance && o.material >= count)
      throw Error("object " + std::to_string(i) + " has material " + std::to_string(o.material) + ", but there are " +
                  std::to_string(count));
  for (const auto& group : geometry.groups) check_materials(*group, count);
}

void check(const Scene& scene, const RenderOptions& options) {
  const glm::ivec2 size = scene.camera.size;
  const std::string shape = std::to_string(size.x) + "x" + std::to_string(size.y);
  if (size.x < 1 || size.y < 1)
    throw Error("cannot render an image of " + shape + " pixels: give a width and a height of at least 1");
  if (std::int64_t{size.x} * size.y > most_pixels)
    throw Error("cannot render an image of " + shape + " pixels: " + std::to_string(most_pixels) +
                " in all is the most");
  if (options.depth < 0) throw Error("the depth is negative: give the number of bounces, 0 for none");
  if (options.depth > most_depth) throw Error("the depth is above " + std::to_string(most_depth) + ": give less");
  if (options.spp < 1) throw Error("no samples per pixel: give at least 1");
  if (options.caustics < 0 || options.caustics > most_photons)
    throw Error("caustics of " + std::to_string(options.caustics) + " photons were asked for: give 0 to " +
                std::to_string(most_photons));
  if (options.caustics > 0 && options.shading == Shading::direct)
    throw Error("the shading direct knows no glass and no mirrors, and so no caustics: choose full");
  if (!scene.geometry) throw Error("the scene has no geometry to render");
  check_materials(*scene.geometry, scene.materials.size());
  for (std::size_t i = 0; i < options.aovs.size(); ++i)
    if (std::count(options.aovs.begin(), options.aovs.end(), options.aovs[i]) > 1)
      throw Error("the output variable " + channel_names({&options.aovs[i], 1}).front() +
                  " is asked for twice: give it once");
}

/// The materials as the model uses them: `direct` knows nothing but Lambert.
std::vector<Material> materials_for(Shading shading, std::vector<Material> materials) {
  if (shading == Shading::full) return materials;
  for (Material& m : materials)
    m = {.color = m.color, .ambient = 0, .diffuse = m.diffuse, .specular = 0, .reflect = 0, .transmit = 0};
  return materials;
}

std::vector<std::string> channels_for(const RenderOptions& options) {
  std::vector<std::string> names{"R", "G", "B", "A"};
  for (std::string& name : channel_names(options.aovs)) names.push_back(std::move(name));
  return names;
}

/// A picture that is yet to be written.
Image blank_image(const glm::ivec2& size, std::vector<std::string> channels) {
  Image image;
  image.width = size.x, image.height = size.y;
  image.channels = std::move(channels);
  image.pixels.resize(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * image.channels.size());
  return image;
}

/// Rays of a wave: what the tracer uses well, unless threads would then run out of tiles.
std::size_t wave_size(const glm::ivec2& size, int spp, const Limits& limits, int threads) {
  if (!limits.concurrent) return limits.batch;
  const std::size_t rays =
      static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(spp);
  return std::min(limits.batch, rays / (tiles_per_thread * static_cast<std::size_t>(threads)));
}

}  // namespace

RenderResult render(const Scene& scene, Tracer& tracer, const RenderOptions& options) {
  const Stopwatch watch;
  check(scene, options);
  const CameraFrame camera(scene.camera);
  const Environment environment(scene.background);
  const std::vector<Material> materials = materials_for(options.shading, scene.materials);
  Picture picture{*scene.geometry, scene.lights,  materials, environment,
                  tracer.limits(), options.depth, nullptr,   scene.object_numbers};
  const PixelSampler sampler(options.spp);
  RenderResult result{blank_image(scene.camera.size, channels_for(options)), {}};

  // More threads than cores are given too, when asked for.
  const std::size_t workers = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const tbb::global_control allowance(tbb::global_control::max_allowed_parallelism,
                                      std::max(workers, static_cast<std::size_t>(std::max(options.threads, 1))));
  tbb::task_arena arena(options.threads > 0 ? options.threads : tbb::task_arena::automatic);
  const Tiling tiling(scene.camera.size, options.spp,
                      wave_size(scene.camera.size, options.spp, picture.limits, arena.max_concurrency()));
  std::mutex door;
  tbb::enumerable_thread_specific<TileRenderer> renderers(std::cref(picture), std::cref(camera), std::cref(sampler),
                                                          std::cref(tiling), std::cref(options),
                                                          TracerGate(tracer, door));
  std::optional<Caustics> caustics;
  if (options.caustics > 0) {
    arena.execute([&] {
      caustics.emplace(trace_caustics(scene, tracer, static_cast<std::size_t>(options.caustics), options.depth));
    });
    picture.caustics = &caustics->map;
    result.stats.photon_rays = caustics->rays;
  }
  std::atomic<std::size_t> done = 0;
  arena.execute([&] {
    tbb::parallel_for(
        std::size_t{0}, tiling.count(),
        [&](std::size_t tile) {
          renderers.local().render(tile, result.image);
          const std::size_t share = ++done;
          if (options.progress) options.progress(static_cast<double>(share) / static_cast<double>(tiling.count()));
        },
        tbb::simple_partitioner());
  });
  for (const TileRenderer& r : renderers) r.add_to(result.stats);
  result.stats.seconds = watch.seconds();
  return result;
}

}  // namespace rayengine
