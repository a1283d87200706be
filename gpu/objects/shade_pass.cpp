#include "gpu/objects/shade_pass.h"

#include <algorithm>

namespace rayengine {
namespace {

constexpr GLint light_count_location = 1;

Program make_program() {
  return make_screen_program("shade",
                             {0,
                              {"accel/kernels/prelude.glsl", "accel/kernels/highlight.glsl", "gpu/shaders/shade.glsl",
                               "gpu/shaders/objects/packed.glsl", "gpu/shaders/objects/shade.frag.glsl"},
                              {}});
}

}  // namespace

ShadePass::ShadePass(const Geometry& geometry, const LocalFrame& frame, std::span<const CastLight> lights,
                     std::span<const CastMaterial> materials, GLsizei side)
    : program_(make_program()),
      textures_(geometry, frame, lights, materials),
      light_count_(static_cast<GLint>(lights.size())),
      side_(side),
      color_(make_texture(GL_RGBA32F, side, side)),
      read_back_(make_mapped_buffer(static_cast<std::size_t>(side * side) * sizeof(glm::vec4), Mapping::read_back)) {
  glNamedFramebufferTexture(frame_.id(), GL_COLOR_ATTACHMENT0, color_.object.id(), 0);
}

void ShadePass::run(std::span<glm::vec4> colors, Context& context) {
  textures_.bind();
  glBindFramebuffer(GL_FRAMEBUFFER, frame_.id());
  program_.use();
  glUniform1i(light_count_location, light_count_);
  draw_everywhere();
  glBindBuffer(GL_PIXEL_PACK_BUFFER, read_back_.object.id());
  const auto rows =
      static_cast<GLsizei>((colors.size() + static_cast<std::size_t>(side_) - 1) / static_cast<std::size_t>(side_));
  glReadPixels(0, 0, side_, rows, GL_RGBA, GL_FLOAT, nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
  await(Fence(), context);
  const auto seen = read_back_.as<const glm::vec4>(0, colors.size());
  std::copy(seen.begin(), seen.end(), colors.begin());
}

}  // namespace rayengine
