#include "gpu/cones/cones_pass.h"

#include <array>

#include "accel/tracer.h"
#include "gpu/scene/kernel_program.h"

namespace rayengine {
namespace {

enum : GLuint { apexes_unit = 9, axes_unit = 10, spheres_unit = 11 };
enum : GLint { tile_location = 5, extent_location = 6, first_sphere_location = 7 };

Program make_build() {
  return make_screen_program("cones",
                             {0,
                              {"accel/kernels/prelude.glsl", "accel/kernels/box.glsl", "accel/kernels/ray_cone.glsl",
                               "gpu/shaders/stream/ray.glsl", "gpu/shaders/cones/build.frag.glsl"},
                              {}});
}

Program make_test(KernelType type, const std::vector<std::string>& defines) {
  const Stage vertex{GL_VERTEX_SHADER,
                     {"accel/kernels/prelude.glsl", "accel/kernels/ray_cone.glsl", "gpu/shaders/cones/point.vert.glsl"},
                     {}};
  return Program(kernel_name(type), {vertex, kernel_stage(type, point_sources(), defines)});
}

void require_points(GLsizei size) {
  std::array<GLfloat, 2> range{};
  glGetFloatv(GL_POINT_SIZE_RANGE, range.data());
  if (static_cast<float>(size) > range[1])
    throw Error("the GPU draws points of up to " + std::to_string(static_cast<int>(range[1])) +
                " pixels, less than a tile of " + std::to_string(size) + " rays a side; use --tracer stream");
}

}  // namespace

std::vector<std::string_view> point_sources() {
  return {"gpu/shaders/stream/ray.glsl", "gpu/shaders/stream/consider.glsl", "gpu/shaders/cones/point.glsl"};
}

ConesPass::ConesPass(const ConesScene& scene, glm::ivec2 extent, GLsizei tile, const std::vector<std::string>& defines)
    : scene_(scene),
      tile_(tile),
      build_(make_build()),
      apexes_(make_texture(GL_RGBA32F, extent.x / tile, extent.y / tile)),
      axes_(make_texture(GL_RGBA32F, extent.x / tile, extent.y / tile)) {
  require_points(tile);
  std::vector<std::string> all = defines;
  if (scene.bounded.size() > 1) {
    all.push_back("SEVERAL_TYPES");
    before_ = make_texture(GL_RG32UI, extent.x, extent.y);
  }
  for (const ConesScene::Run& run : scene.bounded) tests_.push_back(make_test(scene.textures.types[run.type], all));
  glNamedFramebufferTexture(frame_.id(), GL_COLOR_ATTACHMENT0, apexes_.object.id(), 0);
  glNamedFramebufferTexture(frame_.id(), GL_COLOR_ATTACHMENT1, axes_.object.id(), 0);
  const std::array<GLenum, 2> both{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glNamedFramebufferDrawBuffers(frame_.id(), 2, both.data());
}

void ConesPass::build(glm::ivec2 extent) {
  glBindFramebuffer(GL_FRAMEBUFFER, frame_.id());
  glViewport(0, 0, extent.x / tile_, extent.y / tile_);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_STENCIL_TEST);
  glBindVertexArray(vertices_.id());
  build_.use();
  glUniform1i(tile_location, tile_);
  draw_everywhere();
}

void ConesPass::draw(glm::ivec2 extent, const Texture& hits) const {
  glBindVertexArray(vertices_.id());
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glPointSize(static_cast<GLfloat>(tile_));
  apexes_.bind(apexes_unit);
  axes_.bind(axes_unit);
  scene_.spheres.bind(spheres_unit);
  scene_.textures.bind();
  for (std::size_t i = 0; i < tests_.size(); ++i) {
    if (tests_.size() > 1) {
      glCopyImageSubData(hits.object.id(), GL_TEXTURE_2D, 0, 0, 0, 0, before_.object.id(), GL_TEXTURE_2D, 0, 0, 0, 0,
                         extent.x, extent.y, 1);
      before_.bind(hits_unit);
    }
    tests_[i].use();
    draw(scene_.bounded[i], extent);
  }
  glDisable(GL_DEPTH_TEST);
}

void ConesPass::draw(const ConesScene::Run& run, glm::ivec2 extent) const {
  glUniform1i(tile_location, tile_);
  glUniform2i(extent_location, extent.x, extent.y);
  glUniform1i(first_sphere_location, static_cast<GLint>(run.first_sphere));
  glDrawArraysInstanced(GL_POINTS, static_cast<GLint>(run.first), static_cast<GLsizei>(run.count),
                        extent.x / tile_ * (extent.y / tile_));
}

}  // namespace rayengine
