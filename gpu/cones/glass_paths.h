#pragma once

#include <array>
#include <optional>

#include "gpu/cast_watch.h"
#include "gpu/cones/cones_pass.h"
#include "gpu/cones/glass_caster.h"

namespace rayengine {

/// The paths of one picture: rays and hits as textures, a texel a pixel, rounded up to whole tiles.
class GlassPaths {
 public:
  /// `scene` must outlive this.
  GlassPaths(const ConesScene& scene, glm::ivec2 picture, const GlassOptions& options);

  glm::ivec2 picture() const { return picture_; }
  glm::ivec2 extent() const { return extent_; }
  ConesPass& cones() { return cones_; }
  /// Binds the rays of the current generation as gpu/shaders/stream/ray.glsl reads them.
  void bind_rays() const;
  /// Binds the frame of the current or the next generation's rays.
  void draw_to_current() const;
  void draw_to_next() const;
  void turn() { current_ = 1 - current_; }

  /// Finds the nearest hits of the current rays, the `generation`-th from 0. The watch runs.
  void intersect(int generation, CastWatch& watch);

 private:
  struct Rays {
    Texture origins, directions;
    Framebuffer frame = make_framebuffer();
  };

  void clear(int generation) const;
  void mask(int generation) const;
  void draw_plainly(int stride) const;

  const ConesScene& scene_;
  GlassOptions options_;
  glm::ivec2 picture_, extent_;
  ConesPass cones_;
  std::vector<Program> plain_;  // by run
  std::array<Rays, 2> rays_;
  std::size_t current_ = 0;
  Texture hits_, depth_stencil_;
  Framebuffer frame_ = make_framebuffer();
  VertexArray vertices_ = make_vertex_array();
};

}  // namespace rayengine
