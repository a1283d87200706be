#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "accel/geometry.h"
#include "gpu/cast_watch.h"
#include "gpu/device/context.h"
#include "gpu/objects/ray_caster.h"

namespace rayengine {

/// Rays of a pinhole camera: the one through the middle of pixel (x, y), counted from the upper left corner, runs from
/// `eye` along corner + x * right + y * down. World coordinates.
struct CastView {
  glm::dvec3 eye{0}, corner{0}, right{0}, down{0};
  int width = 0, height = 0;
};

struct PointsOptions {
  enum class Method {
    points,             ///< the geometry shader emits the rays that follow
    points_without_gs,  ///< there is none: one draw for every kind of ray that follows, over all pixels
    fragment,           ///< the baseline: one pass, all of a pixel's rays in one loop of a fragment shader
  };
  Method method = Method::points;
  bool naive = false;   ///< every ray against every triangle, instead of through the scene's grid
  bool fat = false;     ///< vertices of 64 bytes, shaded in fragments, as the paper has them, where 32 will do
  bool shadows = true;  ///< rays to the lights
  int reflections = 0;  ///< how many may follow each other
  double room = 0;      ///< rays that vertex buffers hold, for each pixel; 0 for all that can come
  int device = -1;      ///< an EGL device by its number; the best when negative
};

/// Whole pictures by the points tracer's pipeline. Source: Ralovich, Magdics, "Recursive Ray Tracing in Geometry
/// Shader" (2010): the vertex shader intersects rays, which are points; the geometry shader shows them and emits those
/// that follow, which transform feedback takes to the next pass; blending composites. Large vertices are shaded in the
/// fragment shader, as in the paper; small ones before they are drawn, where devices have more of them in step.
/// Every pass is issued at once, without queries in between.
///
/// The paper composites one light and one reflection. Here each light has a render target of its own beside one for
/// what no shadow can take away, and each generation a layer of them, so that a shadow ray puts out just what its light
/// brought; a last pass adds them up. Flat normals; no refraction.
class PointsCaster {
 public:
  /// Object::material indexes `materials`. Throws Error without a GPU, when a material is missing, and when the scene,
  /// or the lights, are more than the method carries.
  PointsCaster(std::shared_ptr<const Geometry> geometry, std::span<const CastLight> lights,
               std::span<const CastMaterial> materials, const glm::vec3& background, const PointsOptions& options = {});
  ~PointsCaster();

  /// Linear colours, row by row from the upper left corner. From any thread, one at a time. Throws Error when the
  /// device fails, when the picture's rays are more than its vertex buffers may be, or were more than they held.
  std::vector<glm::vec3> cast(const CastView& view);

  /// Draws `view` and waits until it is done, without reading it back.
  CastSeconds time(const CastView& view);

  /// What the shaders of Method::points take, one stage after the other.
  enum class Part {
    vertex,    ///< intersecting the rays of every pass
    geometry,  ///< that, and emitting those that follow
  };
  /// The same for one part of the work, on the rays that the picture drawn last has left: it must be of the same view.
  /// Throws Error where there is no such part, or more than three passes, whose rays are not all left.
  CastSeconds time(const CastView& view, Part part);

  const GpuInfo& gpu() const;

 private:
  class Device;
  std::unique_ptr<GlThread> thread_;
  std::unique_ptr<Device> device_;
};

}  // namespace rayengine
