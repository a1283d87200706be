#include "gpu/cones/glass_paths.h"

#include "accel/ray.h"
#include "gpu/scene/kernel_program.h"

namespace rayengine {
namespace {

constexpr int stencil_bits = 8;

glm::ivec2 whole_tiles(glm::ivec2 picture, int tile) { return (picture + tile - 1) / tile * tile; }

}  // namespace

GlassPaths::GlassPaths(const ConesScene& scene, glm::ivec2 picture, const GlassOptions& options)
    : scene_(scene),
      options_(options),
      picture_(picture),
      extent_(whole_tiles(picture, options.tile)),
      cones_(scene, extent_, options.tile, {"PATHS"}),
      hits_(make_texture(GL_RG32UI, extent_.x, extent_.y)),
      depth_stencil_(make_texture(GL_DEPTH32F_STENCIL8, extent_.x, extent_.y)) {
  for (const ConesScene::Run& run : scene.bounded)
    plain_.push_back(make_kernel_program(scene.textures.types[run.type], point_sources(), {"PATHS", "PLAIN"}));
  for (Rays& rays : rays_) {
    rays.origins = make_texture(GL_RGBA32F, extent_.x, extent_.y);
    rays.directions = make_texture(GL_RGBA32F, extent_.x, extent_.y);
    glNamedFramebufferTexture(rays.frame.id(), GL_COLOR_ATTACHMENT0, rays.origins.object.id(), 0);
    glNamedFramebufferTexture(rays.frame.id(), GL_COLOR_ATTACHMENT1, rays.directions.object.id(), 0);
    const std::array<GLenum, 2> both{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glNamedFramebufferDrawBuffers(rays.frame.id(), 2, both.data());
  }
  glNamedFramebufferTexture(frame_.id(), GL_COLOR_ATTACHMENT0, hits_.object.id(), 0);
  glNamedFramebufferTexture(frame_.id(), GL_DEPTH_STENCIL_ATTACHMENT, depth_stencil_.object.id(), 0);
}

void GlassPaths::bind_rays() const {
  rays_[current_].origins.bind(0);
  rays_[current_].directions.bind(1);
  hits_.bind(hits_unit);
}

void GlassPaths::draw_to_current() const {
  glBindFramebuffer(GL_FRAMEBUFFER, rays_[current_].frame.id());
  glViewport(0, 0, extent_.x, extent_.y);
}

void GlassPaths::draw_to_next() const {
  glBindFramebuffer(GL_FRAMEBUFFER, rays_[1 - current_].frame.id());
  glViewport(0, 0, extent_.x, extent_.y);
}

void GlassPaths::clear(int generation) const {
  glBindFramebuffer(GL_FRAMEBUFFER, frame_.id());
  glViewport(0, 0, extent_.x, extent_.y);
  const GLuint no_hit[4] = {0, no_id, 0, 0};
  constexpr float far_away = 1;
  glClearBufferuiv(GL_COLOR, 0, no_hit);
  glClearBufferfv(GL_DEPTH, 0, &far_away);
  constexpr GLint no_bits = 0;
  glStencilMask(0xFF);
  if (generation == 0) glClearBufferiv(GL_STENCIL, 0, &no_bits);
}

/// Rays are tested where the bit of the generation before is set, and set their own where they hit.
void GlassPaths::mask(int generation) const {
  if (generation > stencil_bits) return;
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(generation == 0 ? GL_ALWAYS : GL_EQUAL, 0xFF, generation == 0 ? 0xFF : 1u << (generation - 1));
  glStencilMask(generation < stencil_bits ? 1u << generation : 0);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
}

void GlassPaths::draw_plainly(int stride) const {
  glBindVertexArray(vertices_.id());
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  scene_.textures.bind();
  for (std::size_t i = 0; i < plain_.size(); ++i) {
    const ConesScene::Run& run = scene_.bounded[i];
    plain_[i].use();
    for (std::uint32_t k = 0; k < run.count; k += static_cast<std::uint32_t>(stride)) {
      glUniform2ui(object_range_location, run.first + k, 1);
      draw_everywhere();
    }
  }
}

void GlassPaths::intersect(int generation, CastWatch& watch) {
  clear(generation);
  mask(generation);
  bind_rays();
  if (options_.method == GlassOptions::Method::ray_engine) {
    watch.stop();
    watch.start();
    draw_plainly(options_.stride);
    watch.stop(options_.stride);
  }
  if (options_.method == GlassOptions::Method::hierarchical || options_.stride > 1) {
    cones_.build(extent_);
    glBindFramebuffer(GL_FRAMEBUFFER, frame_.id());
    glViewport(0, 0, extent_.x, extent_.y);
    mask(generation);
    cones_.draw(extent_, hits_);
  }
  if (options_.method == GlassOptions::Method::ray_engine) watch.start();
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_STENCIL_TEST);
}

}  // namespace rayengine
