#pragma once

#include "accel/grid.h"
#include "gpu/scene/flat_scene.h"
#include "gpu/scene/scene_textures.h"

namespace rayengine {

/// A scene in a uniform grid on the device, as gpu/shaders/grid reads it.
class GridTextures {
 public:
  /// Throws Error when either is larger than the device's buffer textures, or a list longer than a shader's loop.
  GridTextures(const FlatScene& scene, const Grid& grid, const GpuInfo& gpu);

  void bind() const;
  /// Sets the uniforms of a program that is in use.
  void set_uniforms() const;

  const std::vector<KernelType>& types() const { return scene_.types; }
  std::size_t bytes() const;

 private:
  SceneTextures scene_;
  BufferTexture voxels_, triangle_members_, quadric_members_;
  glm::vec3 lower_, cell_, counts_;
};

}  // namespace rayengine
