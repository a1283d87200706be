#include "gpu/points/cast_method.h"

namespace rayengine {
namespace {

constexpr GLint reflections_location = 24;

/// One pass, in which the fragment shader follows all rays of its pixel.
class FragmentMethod : public CastMethod {
 public:
  explicit FragmentMethod(CastScene& scene)
      : scene_(scene),
        program_(make_screen_program(
            "single", {0,
                       scene.ray_sources() + CastScene::tracing_sources() + CastScene::shading_sources() +
                           Sources{"gpu/shaders/points/single.frag.glsl"},
                       scene.defines()})) {}

  void draw(const CastView& view, GLuint) override {
    scene_.use(program_, view);
    glUniform1i(reflections_location, scene_.options().reflections);
    glBindVertexArray(no_vertices_.id());
    draw_everywhere();
  }

 private:
  CastScene& scene_;
  Program program_;
  VertexArray no_vertices_ = make_vertex_array();
};

}  // namespace

std::unique_ptr<CastMethod> make_fragment_method(CastScene& scene) { return std::make_unique<FragmentMethod>(scene); }

}  // namespace rayengine
