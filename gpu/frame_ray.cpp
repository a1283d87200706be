#include "gpu/frame_ray.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace rayengine {
namespace {

constexpr double far_t = 1e37;  // leaves room for arithmetic in single precision

/// How far to move an origin, in lengths of `d`: to a little before the closest approach to the frame's unit cube,
/// unless the origin is near it already and its own rounding is small.
double approach(const glm::dvec3& o, const glm::dvec3& d) {
  const double reach = std::max({std::abs(o.x), std::abs(o.y), std::abs(o.z)});
  if (reach <= 4) return 0;
  const double dd = glm::dot(d, d);
  return std::max(-glm::dot(o, d) / dd - 2 / std::sqrt(dd), 0.0);
}

}  // namespace

FrameRay in_frame(const LocalFrame& frame, const Ray& ray) {
  const glm::dvec3 size = glm::abs(ray.direction);
  const double unit = std::ldexp(1, std::ilogb(std::max({size.x, size.y, size.z})));
  const glm::dvec3 o = (ray.origin - frame.center) * frame.scale, d = ray.direction / unit;
  FrameRay result;
  result.shift = approach(o, d);
  result.per_t = unit * frame.scale;
  result.origin = glm::vec3(o + result.shift * d);
  result.direction = glm::vec3(d);
  result.tmin = static_cast<float>(std::clamp(result.to_frame(ray.tmin), -far_t, far_t));
  result.tmax = static_cast<float>(std::clamp(result.to_frame(ray.tmax), -far_t, far_t));
  return result;
}

}  // namespace rayengine
