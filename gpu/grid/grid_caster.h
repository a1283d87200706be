#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "accel/geometry.h"
#include "gpu/grid/grid_kernels.h"
#include "gpu/grid/grid_tracer.h"
#include "gpu/points/points_caster.h"

namespace rayengine {

struct GridCastOptions {
  GridTracerOptions tracer;  ///< but for `batch_side`, as a picture is one batch; without a policy passes by turns
  bool shadows = true;       ///< rays to the first light
  int reflections = 0;       ///< how many may follow each other
};

/// Whole pictures by the four kernels of Purcell, Buck, Mark and Hanrahan, "Ray Tracing on Programmable Graphics
/// Hardware" (2002): eye rays, traverse, intersect, shade, over one stream of rays with a state each; see
/// make_grid_tracer. As in the paper at most one ray goes on from a surface: the reflected one where it mirrors, else
/// one to the first light; light that no ray asks after is taken to arrive. Flat normals; no refraction.
class GridCaster {
 public:
  /// Object::material indexes `materials`. Throws Error as make_grid_tracer, and when a material is missing.
  GridCaster(std::shared_ptr<const Geometry> geometry, std::span<const CastLight> lights,
             std::span<const CastMaterial> materials, const glm::vec3& background, const GridCastOptions& options = {});
  ~GridCaster();

  /// Linear colours, row by row from the upper left corner. From any thread, one at a time. Throws Error when the
  /// device fails, or its textures are smaller than the picture.
  std::vector<glm::vec3> cast(const CastView& view);

  /// Draws `view` without reading it back, and says what its kernels did; each is waited for.
  GridWork measure(const CastView& view);
  /// Draws it without waiting between, and says what that took.
  CastSeconds time(const CastView& view);
  /// Of the grid: voxels along each axis, and entries in its lists.
  glm::uvec3 resolution() const;
  std::size_t members() const;
  const GpuInfo& gpu() const;

 private:
  class Device;
  std::unique_ptr<GlThread> thread_;
  std::unique_ptr<Device> device_;
};

}  // namespace rayengine
