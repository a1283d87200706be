#include "gpu/objects/objects_engine.h"

#include <algorithm>

#include "gpu/batches.h"
#include "gpu/device/probe.h"
#include "gpu/scene/kernel_program.h"

namespace rayengine {
namespace {

constexpr GLsizei side = 256;

Program make_program(KernelType type, Precision precision) {
  if (precision == Precision::half)
    return make_kernel_program(type, {"gpu/shaders/objects/packed.glsl", "gpu/shaders/objects/half.glsl"},
                               {"OBJECT", "HALF"});
  return make_kernel_program(
      type, {"gpu/shaders/stream/ray.glsl", "gpu/shaders/stream/consider.glsl", "gpu/shaders/stream/nearest.glsl"},
      {"OBJECT"});
}

}  // namespace

ObjectsEngine::ObjectsEngine(std::shared_ptr<const Geometry> geometry, Precision precision, int device)
    : context_(device),
      scene_(flatten(std::move(geometry))),
      list_(list_all(*scene_.geometry)),
      textures_(upload(scene_, list_, context_.info())),
      passes_(passes()) {
  require_usable(context_);
  for (const KernelType type : textures_.types) programs_.push_back(make_program(type, precision));
  batch_.emplace(side, precision == Precision::half);
  context_.check_errors("the upload of the scene");
}

/// In the order of types, so that programs change rarely.
std::vector<ObjectsEngine::Pass> ObjectsEngine::passes() const {
  std::vector<Pass> result;
  const auto& owners = scene_.geometry->triangle_object;
  for (std::uint32_t i = 0; i < owners.size(); ++i)
    if (i > 0 && owners[i] == owners[i - 1] && result.back().count < longest_loop)
      ++result.back().count;
    else
      result.push_back({0, i, 1});
  for (std::uint32_t i = 0; i < list_.quadrics.size(); ++i) {
    const auto type = static_cast<std::uint32_t>(scene_.geometry->quadrics[list_.quadrics[i]].type);
    const auto place = std::find(textures_.types.begin(), textures_.types.end(), type) - textures_.types.begin();
    result.push_back({static_cast<std::size_t>(place), i, 1});
  }
  return result;
}

GLsizei ObjectsEngine::batch_side() const { return side; }

void ObjectsEngine::cast(std::span<const Traveller> travellers) {
  glBindVertexArray(vertices_.id());
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  batch_->upload(travellers);
  textures_.bind();
  std::size_t current = textures_.types.size();
  for (const Pass& pass : passes_) {
    if (pass.type != std::exchange(current, pass.type)) programs_[pass.type].use();
    batch_->turn();
    glUniform2ui(object_range_location, pass.first, pass.count);
    draw_everywhere();
  }
  batch_->turn();
}

void ObjectsEngine::trace(std::span<const Ray> rays, StreamQuery, const Arrive& arrive) {
  const auto answer = [this](std::span<Traveller> travellers) {
    cast(travellers);
    batch_->read_back(travellers, context_);
  };
  trace_in_batches(
      rays, batch_rays(), [this](const Ray& ray) { return in_frame(list_.frame, ray); }, answer, arrive);
}

}  // namespace rayengine
