#include <algorithm>
#include <optional>
#include <string>

#include "accel/tracer.h"
#include "gpu/points/cast_method.h"
#include "gpu/points/fresh_rays.h"
#include "gpu/points/layered_target.h"
#include "gpu/points/locations.h"
#include "gpu/points/point_stream.h"

namespace rayengine {
namespace {

enum : GLint { reflects_location = 24, generation_location = 26 };

/// Small vertices that none follow need less handed on from stage to stage.
bool only_casts(const CastScene& scene) { return !scene.options().fat && !scene.followed(); }

Program points_program(const CastScene& scene) {
  const Sources end = CastScene::shading_sources();
  const auto stage = [&](GLenum type, const Sources& sources) {
    return Stage{type, scene.ray_sources() + sources, scene.defines()};
  };
  const bool casts = only_casts(scene);
  const std::string_view vertex =
      casts ? "gpu/shaders/points/casting.vert.glsl" : "gpu/shaders/points/points.vert.glsl";
  const std::string_view geometry =
      casts ? "gpu/shaders/points/casting.geom.glsl" : "gpu/shaders/points/points.geom.glsl";
  return Program("points", {stage(GL_VERTEX_SHADER, CastScene::tracing_sources() + end + Sources{vertex}),
                            stage(GL_GEOMETRY_SHADER, end + Sources{geometry}),
                            stage(GL_FRAGMENT_SHADER, end + Sources{"gpu/shaders/points/points.frag.glsl"})});
}

/// The vertex shader alone, whose results decide where off the screen points lie.
Program make_vertex_stage(const CastScene& scene) {
  Stage stage{GL_VERTEX_SHADER,
              scene.ray_sources() + CastScene::tracing_sources() + Sources{"gpu/shaders/points/points.vert.glsl"},
              scene.defines()};
  stage.defines.push_back("NOTHING_FOLLOWS");
  return Program("vertex stage", {stage});
}

/// The vertex shader intersects, the geometry shader emits, two vertex buffers take turns.
class PointsMethod : public CastMethod {
 public:
  PointsMethod(CastScene& scene, const CastView& view)
      : scene_(scene),
        program_(points_program(scene)),
        target_(view.width, view.height, scene.targets(), scene.layers()),
        fresh_(fresh_rays(format(), view)) {
    for (int i = 0; i < std::min(2, passes() - 1); ++i) streams_.emplace_back(room(view), format());
    counts_.resize(static_cast<std::size_t>(passes() - 1));
  }

  void draw(const CastView& view, GLuint framebuffer) override {
    target_.begin(framebuffer);
    draw_passes(view);
    target_.add_up(framebuffer);
  }

  void draw_part(const CastView& view, PointsCaster::Part part) override {
    if (passes() > 3)
      throw Error("a picture of " + std::to_string(passes()) + " passes cannot be timed by parts, and one of 3 can");
    if (part == PointsCaster::Part::vertex) return draw_vertex_stage(view);
    glEnable(GL_RASTERIZER_DISCARD);
    draw_passes(view);
    glDisable(GL_RASTERIZER_DISCARD);
  }

  void check() const override {
    for (const PointCount& count : counts_) count.check(streams_.front().capacity());
  }

 private:
  /// The last one's rays have none that follow, and so are not written.
  int passes() const { return 1 + scene_.options().reflections + scene_.shadows(); }
  RayFormat format() const { return scene_.options().fat ? RayFormat::fat : RayFormat::packed; }
  GLuint written_stream() const { return scene_.options().fat ? 0 : 1; }

  /// The most that a pass which others follow writes for a pixel. Small vertices are written only if they wait.
  int rays_of_a_pixel() const {
    const int shadows = scene_.shadows() ? scene_.lights() : 0, reflections = scene_.options().reflections;
    if (!scene_.options().fat) return shadows + (reflections > 0);
    int most = 0;
    for (int pass = 0; pass + 1 < passes(); ++pass)
      most = std::max(most, 1 + (pass > 0 ? shadows : 0) + shadows + (pass < reflections));
    return most;
  }

  std::size_t room(const CastView& view) const {
    const double asked = scene_.options().room, each = asked > 0 ? asked : rays_of_a_pixel();
    return std::max<std::size_t>(1, static_cast<std::size_t>(each * view.width * view.height));
  }

  void draw_passes(const CastView& view) const {
    scene_.use(program_, view);
    glUniform1i(sees_background_location, scene_.sees_background());
    for (int pass = 0; pass + 1 < passes(); ++pass) {
      const PointStream& to = streams_[static_cast<std::size_t>(pass % 2)];
      const PointCount& count = counts_[static_cast<std::size_t>(pass)];
      to.begin_writing();
      count.begin(written_stream());
      draw_pass(pass);
      count.end(written_stream());
      to.end_writing();
    }
    draw_pass(passes() - 1);
  }

  void draw_vertex_stage(const CastView& view) {
    if (!vertex_stage_) vertex_stage_.emplace(make_vertex_stage(scene_));
    scene_.use(*vertex_stage_, view);
    for (int pass = 0; pass < passes(); ++pass) draw_points(pass);
  }

  void draw_pass(int pass) const {
    if (!only_casts(scene_)) {
      glUniform1i(reflects_location, pass < scene_.options().reflections);
      glUniform1i(generation_location, pass);
    }
    draw_points(pass);
  }

  void draw_points(int pass) const {
    if (pass == 0)
      fresh_.draw(static_cast<GLsizei>(fresh_.capacity()));
    else
      streams_[static_cast<std::size_t>((pass - 1) % 2)].draw_written(written_stream());
  }

  CastScene& scene_;
  Program program_;
  std::optional<Program> vertex_stage_;
  LayeredTarget target_;
  PointStream fresh_;
  std::vector<PointStream> streams_;
  std::vector<PointCount> counts_;  // for each pass that writes
};

}  // namespace

std::unique_ptr<CastMethod> make_points_method(CastScene& scene, const CastView& view) {
  return std::make_unique<PointsMethod>(scene, view);
}

}  // namespace rayengine
