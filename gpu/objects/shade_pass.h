#pragma once

#include <span>

#include "accel/bvh.h"
#include "gpu/device/await.h"
#include "gpu/device/program.h"
#include "gpu/scene/shading_textures.h"

namespace rayengine {

/// The pass that turns an ObjectsBatch of halves into colours.
class ShadePass {
 public:
  /// For batches of side x side rays, whose hits are in `frame`. Throws Error when a material is missing.
  ShadePass(const Geometry& geometry, const LocalFrame& frame, std::span<const CastLight> lights,
            std::span<const CastMaterial> materials, GLsizei side);

  /// Shades the batch whose rays and hits are bound, and waits for the colours of its first rays.
  void run(std::span<glm::vec4> colors, Context& context);

 private:
  Program program_;
  ShadingTextures textures_;
  GLint light_count_;
  GLsizei side_;
  Texture color_;
  Framebuffer frame_ = make_framebuffer();
  MappedBuffer read_back_;
};

}  // namespace rayengine
