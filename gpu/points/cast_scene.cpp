#include "gpu/points/cast_scene.h"

#include "accel/tracer.h"
#include "gpu/device/probe.h"
#include "gpu/points/locations.h"

namespace rayengine {
namespace {

enum : GLint {
  scene_lower_location = 16,
  scene_upper_location,
  structure_location,  // the number of triangles, or the first list
  eye_location,
  view_corner_location,
  view_right_location,
  view_down_location,
  screen_size_location,
};

/// A render target for each light beside the first, of the eight that OpenGL promises; their numbers take four bits.
constexpr std::size_t most_lights = 7;

std::shared_ptr<const Geometry> checked(std::shared_ptr<const Geometry> geometry, const PointsOptions& options) {
  if (!geometry->quadrics.empty())
    throw Error("the scene has " + std::to_string(geometry->quadrics.size()) +
                " quadrics, and this caster takes 0: use --tracer embree");
  if (options.naive && geometry->triangles.size() > longest_loop)
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

CastScene::CastScene(std::shared_ptr<const Geometry> geometry, std::span<const CastLight> lights,
                     std::span<const CastMaterial> materials, const glm::vec3& background, const PointsOptions& options)
    : options_(options),
      context_(options.device, Profile::compatibility),
      scene_(flatten(geometry)),
      gridded_(scene_, build_grid(*checked(scene_.geometry, options)), context_.info()),
      box_(geometry->bounds, gridded_.frame),
      shading_(*geometry, gridded_.frame, checked(lights), materials),
      lights_(static_cast<GLsizei>(lights.size())),
      background_(background) {
  require_usable(context_);
  context_.check_errors("the upload of the scene");
}

Sources CastScene::ray_sources() const {
  return (options_.naive ? naive_sources : grid_walk_sources) +
         Sources{"accel/kernels/highlight.glsl", "gpu/shaders/points/ray.glsl",
                 options_.fat ? "gpu/shaders/points/fat.glsl" : "gpu/shaders/points/packed.glsl",
                 "gpu/shaders/points/view.glsl", "gpu/shaders/shade.glsl"};
}

Sources CastScene::shading_sources() { return {"gpu/shaders/points/surface.glsl", "gpu/shaders/points/brought.glsl"}; }

std::vector<std::string> CastScene::defines() const {
  std::vector<std::string> result{"LIGHTS=" + std::to_string(lights_), "TARGETS=" + std::to_string(targets()),
                                  grid_tests(gridded_.textures.types())};
  if (options_.fat) result.push_back("FAT");
  if (shadows()) result.push_back("SHADOWS");
  if (options_.reflections > 0) result.push_back("REFLECTIONS");
  return result;
}

void CastScene::bind() const {
  gridded_.textures.bind();
  shading_.bind();
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
}

void CastScene::use(const Program& program, const CastView& view) const {
  const LocalFrame& frame = gridded_.frame;
  program.use();
  set(scene_lower_location, box_.lower);
  set(scene_upper_location, box_.upper);
  if (options_.naive) {
    glUniform1i(structure_location, static_cast<GLint>(scene_.geometry->triangles.size()));
  } else {
    gridded_.textures.set_uniforms();
    glUniform1i(steps_location, 1 << 30);
    glUniform1ui(structure_location, gridded_.first_list);
  }
  set(eye_location, glm::vec3((view.eye - frame.center) * frame.scale));
  set(view_corner_location, glm::vec3(view.corner));
  set(view_right_location, glm::vec3(view.right));
  set(view_down_location, glm::vec3(view.down));
  glUniform2f(screen_size_location, static_cast<float>(view.width), static_cast<float>(view.height));
  set(program.uniform("background"), background_);  // which not all programs have
}

}  // namespace rayengine
