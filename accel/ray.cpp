#include "accel/ray.h"

#include <cmath>

namespace rayengine {
namespace {

bool is_finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

bool is_valid(const Ray& ray) {
  const glm::dvec3& d = ray.direction;
  return is_finite(ray.origin) && is_finite(d) && (d.x != 0 || d.y != 0 || d.z != 0) && ray.tmin <= ray.tmax;
}

}  // namespace rayengine
