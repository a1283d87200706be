#pragma once

#include <span>

#include "accel/bvh.h"
#include "accel/geometry.h"
#include "gpu/device/objects.h"
#include "gpu/objects/ray_caster.h"

namespace rayengine {

/// Which material each primitive has, by rank, the materials, and the lights, as gpu/shaders/shade.glsl reads them.
class ShadingTextures {
 public:
  /// Lights are brought into `frame`. Throws Error when an object's material is missing.
  ShadingTextures(const Geometry& geometry, const LocalFrame& frame, std::span<const CastLight> lights,
                  std::span<const CastMaterial> materials);

  void bind() const;

 private:
  BufferTexture owners_, materials_, lights_;
};

}  // namespace rayengine
