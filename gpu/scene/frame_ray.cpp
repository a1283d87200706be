#include "gpu/scene/frame_ray.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace rayengine {
namespace {

constexpr double far_t = 1e37;  // leaves room for arithmetic in single precision

/// Where the ray comes near the frame's unit cube, in lengths of `d`: a little before its closest approach.
double entry(const glm::dvec3& o, const glm::dvec3& d) {
  const double dd = glm::dot(d, d);
  return -glm::dot(o, d) / dd - 2 / std::sqrt(dd);
}

/// How far to move an origin: to the entry, unless it is near the cube already and its own rounding is small. Backward
/// where the interval begins before it.
double approach(const glm::dvec3& o, const glm::dvec3& d, double least) {
  const double reach = std::max({std::abs(o.x), std::abs(o.y), std::abs(o.z)});
  return reach <= 4 && !(least < 0) ? 0 : std::max(entry(o, d), std::min(least, 0.0));
}

FrameRay moved(const LocalFrame& frame, const Ray& ray, double least) {
  const glm::dvec3 size = glm::abs(ray.direction);
  const double unit = std::ldexp(1, std::ilogb(std::max({size.x, size.y, size.z})));
  const glm::dvec3 o = (ray.origin - frame.center) * frame.scale, d = ray.direction / unit;
  FrameRay result;
  result.shift = approach(o, d, least * unit * frame.scale);
  result.per_t = unit * frame.scale;
  result.origin = glm::vec3(o + result.shift * d);
  result.direction = glm::vec3(d);
  result.tmin = static_cast<float>(std::clamp(result.to_frame(ray.tmin), -far_t, far_t));
  result.tmax = static_cast<float>(std::clamp(result.to_frame(ray.tmax), -far_t, far_t));
  return result;
}

}  // namespace

FrameRay in_frame(const LocalFrame& frame, const Ray& ray) { return moved(frame, ray, 0); }

FrameRay in_frame_from_tmin(const LocalFrame& frame, const Ray& ray) { return moved(frame, ray, ray.tmin); }

}  // namespace rayengine
