#pragma once

#include <epoxy/gl.h>

#include <string>
#include <vector>

#include "gpu/device/context.h"
#include "gpu/device/program.h"
#include "gpu/grid/gridded_scene.h"
#include "gpu/points/find_sources.h"
#include "gpu/points/points_caster.h"
#include "gpu/scene/shading_textures.h"

namespace rayengine {

/// What every way to cast a picture shares: the scene on the device, what shaders are made of, and the view.
class CastScene {
 public:
  CastScene(std::shared_ptr<const Geometry> geometry, std::span<const CastLight> lights,
            std::span<const CastMaterial> materials, const glm::vec3& background, const PointsOptions& options);

  Context& context() { return context_; }
  const PointsOptions& options() const { return options_; }
  GLsizei lights() const { return lights_; }
  bool shadows() const { return options_.shadows && lights_ > 0; }
  /// Whether rays follow others.
  bool followed() const { return shadows() || options_.reflections > 0; }
  /// Where nothing is put out again, a single target will do.
  GLsizei targets() const { return shadows() ? 1 + lights_ : 1; }
  GLsizei layers() const { return shadows() ? 1 + options_.reflections : 1; }
  bool sees_background() const { return background_ != glm::vec3(0); }

  /// Hits, rays as they are laid out, and the view.
  Sources ray_sources() const;
  /// After those: a ray's way through the scene, and what happens at surfaces.
  static Sources tracing_sources() { return {"gpu/shaders/points/trace.glsl"}; }
  static Sources shading_sources();
  std::vector<std::string> defines() const;

  void bind() const;
  /// Makes a program current, with the uniforms of the scene and the view.
  void use(const Program& program, const CastView& view) const;

 private:
  PointsOptions options_;
  Context context_;
  FlatScene scene_;
  GriddedScene gridded_;
  FloatBox box_;  // of the whole scene
  ShadingTextures shading_;
  GLsizei lights_;
  glm::vec3 background_;
};

}  // namespace rayengine
