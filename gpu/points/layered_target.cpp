#include "gpu/points/layered_target.h"

#include <array>
#include <string>

#include "accel/tracer.h"

namespace rayengine {
namespace {

GLuint create_layers(GLsizei width, GLsizei height, GLsizei count) {
  GLint most = 0;
  glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &most);
  if (count > most)
    throw Error("the lights and reflections need " + std::to_string(count) + " layers, and the GPU has " +
                std::to_string(most) + ": allow fewer reflections, or use --tracer embree");
  GLuint id = 0;
  glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &id);
  glTextureStorage3D(id, 1, GL_RGBA32F, width, height, count);
  return id;
}

GLuint generate_texture() {
  GLuint id = 0;
  glGenTextures(1, &id);  // a view must not have been created as anything yet
  return id;
}

void draw_to_all(const Framebuffer& frame, GLsizei targets) {
  std::array<GLenum, 8> attachments{};
  for (GLuint i = 0; i < attachments.size(); ++i) attachments[i] = GL_COLOR_ATTACHMENT0 + i;
  glNamedFramebufferDrawBuffers(frame.id(), targets, attachments.data());
}

}  // namespace

LayeredTarget::View::View(GLuint layers, GLuint first, GLuint count) : object(generate_texture()) {
  glTextureView(object.id(), GL_TEXTURE_2D_ARRAY, layers, GL_RGBA32F, 0, 1, first, count);
}

LayeredTarget::LayeredTarget(GLsizei width, GLsizei height, GLsizei targets, GLsizei generations)
    : targets_(targets), single_(static_cast<std::size_t>(generations)) {
  if (is_sum()) return;
  layers_ = TextureObject(create_layers(width, height, targets * generations));
  sum_.emplace(make_screen_program("sum", {0, {"gpu/shaders/points/sum.frag.glsl"}, {}}));
  for (Framebuffer& frame : single_) frame = make_framebuffer();
  for (GLuint i = 0; i < static_cast<GLuint>(targets); ++i) {
    const GLenum attachment = GL_COLOR_ATTACHMENT0 + i;
    const auto count = static_cast<GLuint>(generations);
    const GLuint view = views_.emplace_back(layers_.id(), i * count, count).object.id();
    glNamedFramebufferTexture(all_.id(), attachment, view, 0);
    for (GLint g = 0; g < generations; ++g)
      glNamedFramebufferTextureLayer(single_[static_cast<std::size_t>(g)].id(), attachment, view, 0, g);
  }
  draw_to_all(all_, targets);
  for (const Framebuffer& frame : single_) draw_to_all(frame, targets);
}

void LayeredTarget::begin(GLuint framebuffer) const {
  const std::array<GLfloat, 4> nothing{};
  const GLuint target = is_sum() ? framebuffer : all_.id();
  glBindFramebuffer(GL_FRAMEBUFFER, target);
  for (GLint i = 0; i < targets_; ++i) glClearNamedFramebufferfv(target, GL_COLOR, i, nothing.data());
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_SRC_ALPHA);
}

void LayeredTarget::choose(GLsizei generation) const {
  if (is_sum()) return;
  glBindFramebuffer(GL_FRAMEBUFFER, single_[static_cast<std::size_t>(generation)].id());
}

void LayeredTarget::add_up(GLuint framebuffer) const {
  glDisable(GL_BLEND);
  if (is_sum()) return;
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glBindTextureUnit(0, layers_.id());
  sum_->use();
  draw_everywhere();
}

}  // namespace rayengine
