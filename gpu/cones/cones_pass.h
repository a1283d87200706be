#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "gpu/cones/cones_scene.h"
#include "gpu/device/program.h"

namespace rayengine {

/// How kernels read and write rays under the depth test, as cones do; for kernel_stage().
std::vector<std::string_view> point_sources();

/// The two steps of the hierarchical ray engine: the cones around tiles of rays, and for each tile the primitives that
/// its cone may meet, drawn as points of the tile's size.
class ConesPass {
 public:
  /// For textures of up to `extent` rays in tiles of `tile` x `tile`, of which it is a multiple. `scene` must outlive
  /// this. `defines` are added to the kernels. Throws Error when the device draws no points of that size.
  ConesPass(const ConesScene& scene, glm::ivec2 extent, GLsizei tile, const std::vector<std::string>& defines = {});

  /// Builds the cones of the rays that are bound as gpu/shaders/stream/ray.glsl has them, of which `extent` are in use.
  void build(glm::ivec2 extent);

  /// Tests them, under the depth test, against all primitives that have an end; nearest hits are written to the bound
  /// frame, whose colours are `hits`, and whose viewport is `extent`. t counts where it is not below zero.
  void draw(glm::ivec2 extent, const Texture& hits) const;

  /// Of each tile: apex and cosine; axis and sine of half the opening. A cosine above 1 holds no ray, one below 0 all.
  const Texture& apexes() const { return apexes_; }
  const Texture& axes() const { return axes_; }

 private:
  void draw(const ConesScene::Run& run, glm::ivec2 extent) const;

  const ConesScene& scene_;
  GLsizei tile_;
  Program build_;
  std::vector<Program> tests_;  // by run
  Texture apexes_, axes_;
  Texture before_;  // the hits of other types' draws
  Framebuffer frame_ = make_framebuffer();
  VertexArray vertices_ = make_vertex_array();
};

}  // namespace rayengine
