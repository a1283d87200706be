#include "gpu/grid/grid_engine.h"

#include <tbb/parallel_for.h>

#include "gpu/batches.h"
#include "gpu/device/probe.h"

namespace rayengine {
namespace {

GLsizei batch_side(const GridTracerOptions& options, const GpuInfo& gpu) {
  const int wanted = options.batch_side ? options.batch_side : gpu.software ? 256 : 1024;
  return std::min(wanted, gpu.texture_size) / 4 * 4;
}

/// As gpu/shaders/grid/traverse.glsl numbers them.
enum State : std::uint32_t { traversing = 0, intersecting = 1, done = 4 };

}  // namespace

GridEngine::GridEngine(std::shared_ptr<const Geometry> geometry, const GridTracerOptions& options)
    : options_(options), context_(options.device), scene_(flatten(std::move(geometry))) {
  const Grid grid = build_grid(*scene_.geometry, options_.grid);
  frame_ = grid.lists.frame;
  if (grid.lists.unbounded.size() > 0) first_list_ = unbounded_treelet(grid.lists);
  textures_.emplace(scene_, grid, context_.info());
  require_usable(context_);
  batch_.emplace(batch_side(options_, context_.info()));
  batch_->add_target(batch_->input(GridKernels::places_input));
  kernels(StreamQuery::closest);
  context_.check_errors("the upload of the scene");
}

GridKernels& GridEngine::kernels(StreamQuery query) {
  auto& kernels = query == StreamQuery::closest ? closest_ : any_;
  if (!kernels) kernels.emplace(textures_->types(), query, options_.defines);
  return *kernels;
}

void GridEngine::upload(std::span<const Traveller> travellers) {
  const glm::uvec4 start(first_list_, no_id, first_list_ == no_id ? traversing : intersecting, 0);
  const std::size_t count = travellers.size();
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    const std::size_t place = batch_->place(i);
    const Traveller& t = travellers[i];
    batch_->origins()[place] = {t.frame.origin, t.frame.tmin};
    batch_->directions()[place] = {t.frame.direction, t.frame.tmax};
    batch_->lists()[place] = start;
    batch_->entries()[place] = {t.floor_rank, 0};
  });
  for (std::size_t i = count; i < batch_->rays_in_blocks(count); ++i)
    batch_->lists()[batch_->place(i)] = {no_id, no_id, done, 0};
  batch_->upload(count);
}

void GridEngine::answer(std::span<Traveller> travellers, StreamQuery query) {
  upload(travellers);
  const GridPolicy usual{.few = context_.info().software ? 1 : 0.5};
  kernels(query).run(*batch_, *textures_, options_.policy.value_or(usual));
  batch_->read_back();
  batch_->await(context_);
  for (std::size_t i = 0; i < travellers.size(); ++i) {
    const StreamBatch::Answer& answer = batch_->answers()[batch_->place(i)];
    travellers[i].best_t = answer.t, travellers[i].best_rank = answer.rank;
  }
}

void GridEngine::trace(std::span<const Ray> rays, StreamQuery query, const Arrive& arrive) {
  trace_in_batches(
      rays, batch_rays(), [this](const Ray& ray) { return in_frame(frame_, ray); },
      [&](std::span<Traveller> travellers) { answer(travellers, query); }, arrive);
}

}  // namespace rayengine
