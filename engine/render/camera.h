#pragma once

#include <cmath>
#include <glm/geometric.hpp>

#include "accel/ray.h"
#include "engine/scene/scene.h"

namespace rayengine {

/// A camera worked out for shooting rays: right-handed, with right = view x up. The vertical angle spans the image's
/// height, so that pixels are square whatever the image's shape.
class CameraFrame {
 public:
  /// Throws Error when the camera looks nowhere: no distance to `at`, `up` along the view, or an angle out of (0, 180).
  explicit CameraFrame(const Camera& camera);

  /// From the eye to pixel coordinates (x, y), at unit distance along the view.
  glm::dvec3 direction(double x, double y) const { return center_ + (x - middle_.x) * right_ + (middle_.y - y) * up_; }
  /// The ray through pixel coordinates (x, y), in pixels from the upper left corner; its direction has unit length.
  /// Written in place: a copy would wait for all of its parts.
  void start(Ray& ray, double x, double y) const {
    const glm::dvec3 d = direction(x, y);
    ray.origin = from_;
    ray.tmin = 0;
    ray.direction = (1 / std::sqrt(glm::dot(d, d))) * d;
    ray.tmax = infinity;
  }

 private:
  glm::dvec3 from_, center_;  ///< `center_` is the direction through the image's middle
  glm::dvec3 right_, up_;     ///< a pixel's step to the right and up, at unit distance
  glm::dvec2 middle_;         ///< of the image, in pixels
};

}  // namespace rayengine
