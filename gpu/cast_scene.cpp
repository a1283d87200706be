#include "gpu/cast_scene.h"

#include "accel/tracer.h"
#include "gpu/probe.h"

namespace rayengine {
namespace {

enum Location : GLint {
  scene_lower_location = 1,
  scene_upper_location,
  triangle_count_location,
  eye_location,
  view_corner_location,
  view_right_location,
  view_down_location,
  screen_size_location,
};

/// A render target for each light beside the first, of the eight that OpenGL promises; their numbers take four bits.
constexpr std::size_t most_lights = 7;

constexpr std::uint32_t all_in_one = 0xFFFFFFFFu;

std::shared_ptr<const Geometry> checked(std::shared_ptr<const Geometry> geometry) {
  if (!geometry->quadrics.empty())
    throw Error("the scene has " + std::to_string(geometry->quadrics.size()) +
                " quadrics, and this caster takes 0: use --tracer embree");
  if (geometry->triangles.size() > longest_loop)
    throw Error("the scene has " + std::to_string(geometry->triangles.size()) + " triangles, and without a structure " +
                std::to_string(longest_loop) + " can be tested: use --tracer embree");
  return geometry;
}

std::span<const CastLight> checked(std::span<const CastLight> lights) {
  if (lights.size() > most_lights)
    throw Error("the scene has " + std::to_string(lights.size()) + " lights, and there are render targets for " +
                std::to_string(most_lights) + ": use --tracer embree");
  return lights;
}

void set(GLint location, const glm::vec3& v) { glUniform3f(location, v.x, v.y, v.z); }

}  // namespace

Sources operator+(Sources a, const Sources& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

CastScene::CastScene(std::shared_ptr<const Geometry> geometry, std::span<const CastLight> lights,
                     std::span<const CastMaterial> materials, const glm::vec3& background, const PointsOptions& options)
    : options_(options),
      context_(options.device),
      scene_(flatten(geometry)),
      list_(build_treelets(treelet_primitives(*checked(scene_.geometry)), all_in_one, frame_bounds(*scene_.geometry))),
      box_(geometry->bounds, list_.frame),
      textures_(upload(scene_, list_, context_.info())),
      shading_(*geometry, list_.frame, checked(lights), materials),
      lights_(static_cast<GLsizei>(lights.size())),
      background_(background) {
  require_usable(context_);
  context_.check_errors("the upload of the scene");
}

Sources CastScene::ray_sources() const {
  return {"accel/kernels/prelude.glsl",
          "accel/kernels/box.glsl",
          "accel/kernels/triangle.glsl",
          "accel/kernels/highlight.glsl",
          "gpu/shaders/stream/consider.glsl",
          "gpu/shaders/stream/triangle.glsl",
          "gpu/shaders/points/ray.glsl",
          options_.fat ? "gpu/shaders/points/fat.glsl" : "gpu/shaders/points/packed.glsl",
          "gpu/shaders/points/view.glsl"};
}

Sources CastScene::tracing_sources() { return {"gpu/shaders/points/naive.glsl", "gpu/shaders/points/trace.glsl"}; }

Sources CastScene::shading_sources() { return {"gpu/shaders/shade.glsl", "gpu/shaders/points/surface.glsl"}; }

std::vector<std::string> CastScene::defines() const {
  std::vector<std::string> result{"LIGHTS=" + std::to_string(lights_)};
  if (options_.fat) result.push_back("FAT");
  if (shadows()) result.push_back("SHADOWS");
  if (options_.reflections > 0) result.push_back("REFLECTIONS");
  return result;
}

void CastScene::bind() const {
  textures_.bind();
  shading_.bind();
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
}

void CastScene::use(const Program& program, const CastView& view) const {
  const LocalFrame& frame = list_.frame;
  program.use();
  set(scene_lower_location, box_.lower);
  set(scene_upper_location, box_.upper);
  glUniform1i(triangle_count_location, static_cast<GLint>(list_.triangles.size()));
  set(eye_location, glm::vec3((view.eye - frame.center) * frame.scale));
  set(view_corner_location, glm::vec3(view.corner));
  set(view_right_location, glm::vec3(view.right));
  set(view_down_location, glm::vec3(view.down));
  glUniform2f(screen_size_location, static_cast<float>(view.width), static_cast<float>(view.height));
  set(program.uniform("background"), background_);  // which not all programs have
}

}  // namespace rayengine
