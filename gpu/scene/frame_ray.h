#pragma once

#include <cmath>
#include <glm/vec3.hpp>

#include "accel/bvh.h"
#include "accel/ray.h"

namespace rayengine {

/// A ray in single precision, in the coordinates of a LocalFrame, as shaders see it: its origin has been moved along
/// the ray to near the scene, in double, and its direction scaled by a power of two to a largest component in [1, 2).
struct FrameRay {
  glm::vec3 origin{0};
  float tmin = 0;
  glm::vec3 direction{0};
  float tmax = -1;
  double shift = 0;  ///< t' of the frame's ray is t * per_t - shift
  double per_t = 1;

  double to_frame(double t) const { return t * per_t - shift; }
  double to_world(double frame_t) const { return (frame_t + shift) / per_t; }
};

FrameRay in_frame(const LocalFrame& frame, const Ray& ray);

/// The same, begun early enough for t' never to be below zero where the ray meets what the frame holds: its tmin may be
/// less than nothing.
FrameRay in_frame_from_tmin(const LocalFrame& frame, const Ray& ray);

/// What rounding in single precision can make of t in the frame, generously: for choices that must not miss anything.
inline double frame_slack(double frame_t) { return 0x1p-19 * (4 + std::abs(frame_t)); }

}  // namespace rayengine
