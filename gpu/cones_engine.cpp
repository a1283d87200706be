#include "gpu/cones_engine.h"

#include <tbb/parallel_for.h>

#include <string>

#include "gpu/batches.h"
#include "gpu/kernel_program.h"
#include "gpu/probe.h"

namespace rayengine {
namespace {

constexpr GLsizei rays_a_side = 256;

GLsizei side_of(int tile) {
  if (tile < 1 || tile > rays_a_side)
    throw Error("tiles of " + std::to_string(tile) + " rays a side cannot be: give 1 to " +
                std::to_string(rays_a_side));
  return rays_a_side / tile * tile;
}

}  // namespace

ConesEngine::ConesEngine(std::shared_ptr<const Geometry> geometry, const ConesOptions& options)
    : context_(options.device),
      side_(side_of(options.tile)),
      scene_(std::move(geometry), context_.info()),
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

/// What is left of the last row of tiles holds no rays.
void ConesEngine::write(std::span<const Traveller> travellers) {
  tbb::parallel_for(std::size_t{0}, batch_.rays_in_blocks(travellers.size()), [&](std::size_t i) {
    const std::size_t place = batch_.place(i);
    const Traveller& t = i < travellers.size() ? travellers[i] : Traveller();
    batch_.origins()[place] = {t.frame.origin, t.frame.tmin};
    batch_.directions()[place] = {t.frame.direction, t.frame.tmax};
    batch_.entries()[place] = {t.floor_rank, 0, 0, 0};
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
    travellers[i].best_t = answer.t, travellers[i].best_rank = answer.rank;
  }
}

void ConesEngine::trace(std::span<const Ray> rays, StreamQuery, const Arrive& arrive) {
  trace_in_batches(
      rays, batch_rays(), [this](const Ray& ray) { return in_frame_from_tmin(scene_.list.frame, ray); },
      [this](std::span<Traveller> t) { cast(t); }, arrive);
}

}  // namespace rayengine
