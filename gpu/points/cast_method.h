#pragma once

#include <memory>

#include "gpu/points/cast_scene.h"

namespace rayengine {

/// A way to cast pictures of a CastScene, which must outlive it.
class CastMethod {
 public:
  virtual ~CastMethod() = default;

  /// Issues all that makes the picture, into `framebuffer`, which is bound and covers the viewport; nothing here waits
  /// for the device.
  virtual void draw(const CastView& view, GLuint framebuffer) = 0;
  /// Issues one part of that, for the rays that the picture drawn last has left; shows nothing. Throws Error where the
  /// method has no such parts.
  virtual void draw_part(const CastView& view, PointsCaster::Part part);
  /// Of the picture drawn last. Throws Error where rays were lost; waits for the device.
  virtual void check() const {}
};

std::unique_ptr<CastMethod> make_points_method(CastScene& scene, const CastView& view);
std::unique_ptr<CastMethod> make_vertex_method(CastScene& scene, const CastView& view);
std::unique_ptr<CastMethod> make_fragment_method(CastScene& scene);

}  // namespace rayengine
