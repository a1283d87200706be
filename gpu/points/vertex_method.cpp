#include <algorithm>

#include "gpu/points/cast_method.h"
#include "gpu/points/fresh_rays.h"
#include "gpu/points/layered_target.h"
#include "gpu/points/locations.h"

namespace rayengine {
namespace {

constexpr GLint kind_location = 27;
enum Kind : GLint { camera = -2, reflected = -1 };

Program vertex_program(const CastScene& scene) {
  return Program("points without geometry shader",
                 {{GL_VERTEX_SHADER,
                   scene.ray_sources() + CastScene::tracing_sources() + CastScene::shading_sources() +
                       Sources{"gpu/shaders/points/alone.vert.glsl"},
                   scene.defines()},
                  {GL_FRAGMENT_SHADER,
                   scene.ray_sources() + CastScene::shading_sources() + Sources{"gpu/shaders/points/points.frag.glsl"},
                   scene.defines()}});
}

/// One draw over all pixels for every kind of ray: the camera's or the reflected ones, which are kept, then those to
/// each light.
class VertexMethod : public CastMethod {
 public:
  VertexMethod(CastScene& scene, const CastView& view)
      : scene_(scene),
        program_(vertex_program(scene)),
        target_(view.width, view.height, scene.targets(), scene.layers()),
        fresh_(fresh_rays(format(), view)) {
    for (int i = 0; i < 2 && scene.followed(); ++i) streams_.emplace_back(fresh_.capacity(), format());
  }

  void draw(const CastView& view, GLuint framebuffer) override {
    target_.begin(framebuffer);
    scene_.use(program_, view);
    glUniform1i(sees_background_location, scene_.sees_background());
    const PointStream* from = &fresh_;
    for (GLsizei generation = 0; generation <= scene_.options().reflections; ++generation) {
      target_.choose(std::min(generation, scene_.layers() - 1));
      const PointStream* to = streams_.empty() ? nullptr : &streams_[static_cast<std::size_t>(generation % 2)];
      if (to) to->begin_writing();
      draw_kind(generation == 0 ? camera : reflected, *from);
      if (to) to->end_writing();
      for (GLsizei light = 0; scene_.shadows() && light < scene_.lights(); ++light) draw_kind(light, *to);
      from = to;
    }
    target_.add_up(framebuffer);
  }

 private:
  RayFormat format() const { return scene_.options().fat ? RayFormat::fat : RayFormat::hit; }

  static void draw_kind(GLint kind, const PointStream& from) {
    glUniform1i(kind_location, kind);
    from.draw(static_cast<GLsizei>(from.capacity()));
  }

  CastScene& scene_;
  Program program_;
  LayeredTarget target_;
  PointStream fresh_;
  std::vector<PointStream> streams_;
};

}  // namespace

std::unique_ptr<CastMethod> make_vertex_method(CastScene& scene, const CastView& view) {
  return std::make_unique<VertexMethod>(scene, view);
}

}  // namespace rayengine
