#include "gpu/cones/cones_engine.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "gpu/batches.h"
#include "gpu/device/probe.h"
#include "gpu/scene/kernel_program.h"

namespace rayengine {
namespace {

constexpr GLsizei most_a_side = 256;

/// Rays along a side of a batch: so few that a batch is done in seconds, cones or no cones; drivers end what takes
/// longer.
GLsizei side_of(int tile, std::size_t primitives, const GpuInfo& gpu) {
  if (tile < 1 || tile > most_a_side)
    throw Error("tiles of " + std::to_string(tile) + " rays a side cannot be: give 1 to " +
                std::to_string(most_a_side));
  const double most_tests = gpu.software ? 0x1p28 : 0x1p33;
  const double side = std::sqrt(most_tests / static_cast<double>(std::max<std::size_t>(primitives, 1)));
  return std::max(static_cast<int>(std::min<double>(most_a_side, side)) / tile, 1) * tile;
}

/// Bits of a ray's key for each of its six numbers.
constexpr unsigned key_bits = 8;

/// A number of [-range, range) in key_bits; NaN counts as the least.
std::uint32_t digits(float a, float range) {
  constexpr float steps = 1 << key_bits;
  return static_cast<std::uint32_t>(std::min(std::max(0.f, (a / range + 1) * (steps / 2)), steps - 1));
}

/// Rays that are near each other along this curve (Morton's, through origins and directions) have most in common.
std::uint64_t likeness(const FrameRay& ray) {
  const glm::vec3 d = glm::normalize(ray.direction);
  const std::array all{digits(d.x, 1),          digits(ray.origin.x, 4), digits(d.y, 1),
                       digits(ray.origin.y, 4), digits(d.z, 1),          digits(ray.origin.z, 4)};
  std::uint64_t key = 0;
  for (unsigned bit = key_bits; bit-- > 0;)
    for (const std::uint32_t digit : all) key = key << 1 | (digit >> bit & 1);
  return key;
}

}  // namespace

ConesEngine::ConesEngine(std::shared_ptr<const Geometry> geometry, const ConesOptions& options)
    : context_(options.device),
      scene_(std::move(geometry), context_.info()),
      side_(side_of(options.tile, scene_.list.triangles.size() + scene_.list.quadrics.size(), context_.info())),
      pass_(scene_, {side_, side_}, options.tile),
      batch_(side_, options.tile) {
  require_usable(context_);
  for (const ConesScene::Run& run : scene_.unbounded) {
    if (run.count > longest_loop)
      throw Error("the scene has " + std::to_string(run.count) + " surfaces without bounds of one type, more than " +
                  std::to_string(longest_loop) + ", what a shader can test in one loop; use --tracer embree");
    unbounded_.push_back(make_kernel_program(
        scene_.textures.types[run.type],
        {"gpu/shaders/stream/ray.glsl", "gpu/shaders/stream/consider.glsl", "gpu/shaders/stream/nearest.glsl"},
        {"OBJECT"}));
  }
  context_.check_errors("the upload of the scene");
}

/// Tiles want rays that are alike, in whatever order they were asked.
void ConesEngine::take_places(std::span<const Traveller> travellers) {
  order_.resize(travellers.size());
  tbb::parallel_for(std::size_t{0}, travellers.size(), [&](std::size_t i) {
    order_[i] = {likeness(travellers[i].frame), static_cast<std::uint32_t>(i)};
  });
  radix_sort(order_, spare_, 6 * key_bits);
}

/// What is left of the last row of tiles holds no rays.
void ConesEngine::write(std::span<const Traveller> travellers) {
  tbb::parallel_for(std::size_t{0}, batch_.rays_in_blocks(travellers.size()), [&](std::size_t i) {
    const std::size_t place = batch_.place(i);
    const Traveller& t = i < travellers.size() ? travellers[order_[i].index] : Traveller();
    batch_.origins()[place] = {t.frame.origin, t.frame.tmin};
    batch_.directions()[place] = {t.frame.direction, t.frame.tmax};
    batch_.entries()[place] = {t.floor_rank, 0};
  });
  batch_.upload(travellers.size());
}

/// Every ray against all that has no end, each reading and writing its own texel of the hits once, which the barrier
/// makes defined.
void ConesEngine::test_unbounded() const {
  glBindVertexArray(vertices_.id());
  scene_.textures.bind();
  for (std::size_t i = 0; i < unbounded_.size(); ++i) {
    glTextureBarrier();
    unbounded_[i].use();
    glUniform2ui(object_range_location, scene_.unbounded[i].first, scene_.unbounded[i].count);
    draw_everywhere();
  }
}

void ConesEngine::cast(std::span<Traveller> travellers) {
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  take_places(travellers);
  write(travellers);
  const glm::ivec2 extent(side_, batch_.rows());
  pass_.build(extent);
  batch_.bind();
  constexpr float far_away = 1;
  glClearBufferfv(GL_DEPTH, 0, &far_away);
  pass_.draw(extent, batch_.hits());
  batch_.bind();
  test_unbounded();
  batch_.read_back();
  batch_.await(context_);
  for (std::size_t i = 0; i < travellers.size(); ++i) {
    const StreamBatch::Answer& answer = batch_.answers()[batch_.place(i)];
    Traveller& t = travellers[order_[i].index];
    t.best_t = answer.t, t.best_rank = answer.rank;
  }
}

void ConesEngine::trace(std::span<const Ray> rays, StreamQuery, const Arrive& arrive) {
  trace_in_batches(
      rays, batch_rays(), [this](const Ray& ray) { return in_frame_from_tmin(scene_.list.frame, ray); },
      [this](std::span<Traveller> t) { cast(t); }, arrive);
}

}  // namespace rayengine
