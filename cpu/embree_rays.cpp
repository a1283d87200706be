#include "cpu/embree_rays.h"

#include <algorithm>
#include <cmath>

#include "accel/rounding.h"

namespace rayengine {
namespace {

// Single precision directions outside of this would overflow or lose bits when they are multiplied.
constexpr double longest = 1e15, shortest = 1e-15;
constexpr double embree_range = 1.8e18;

double largest_component(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// Clips [enter, leave] to a slab; parallel rays stay as they are when inside it.
void clip(double lo, double hi, double o, double d, double& enter, double& leave) {
  if (d == 0) {
    if (o < lo || o > hi) leave = -infinity;
    return;
  }
  const double a = (lo - o) / d, b = (hi - o) / d;
  enter = std::max(enter, std::min(a, b));
  leave = std::min(leave, std::max(a, b));
}

}  // namespace

RayLoader::RayLoader(const EmbreeScene& scene, Precision precision)
    : box_(scene.finite_bounds()), moves_(precision != Precision::fast), unbounded_(!scene.geometry().bounds.finite()) {
  // Room for the rounding of the entry point itself.
  const double slack = box_.empty() ? 0 : box_.extent() * 0x1p-20;
  if (!box_.empty()) box_ = {box_.lower - slack, box_.upper + slack};
  near_ = moves_ && !box_.empty() ? box_.extent() * EmbreeScene::near_extents : embree_range;
}

bool RayLoader::is_ordinary(const Ray& ray) const {
  const double reach = largest_component(ray.direction);
  return ray.tmin >= 0 && largest_component(ray.origin) <= near_ && reach <= longest && reach >= shortest;
}

RayLoader::Placed RayLoader::place(const Ray& ray) const {
  Placed placed{0, 1, true};
  const double reach = largest_component(ray.direction);
  if (!(reach <= longest && reach >= shortest)) placed.scale = std::ldexp(1.0, -std::ilogb(reach));
  if (ray.tmin >= 0 && largest_component(ray.origin) <= near_) return placed;
  double enter = ray.tmin, leave = ray.tmax;
  for (int axis = 0; axis < 3; ++axis)
    clip(box_.lower[axis], box_.upper[axis], ray.origin[axis], ray.direction[axis], enter, leave);
  const bool misses = enter > leave;
  if (moves_ && std::isfinite(enter) && !misses)
    placed.shift = enter;
  else
    placed.shift = std::isfinite(ray.tmin) ? std::min(ray.tmin, 0.0) : 0;
  placed.traced = (!misses || unbounded_) && largest_component(ray.at(placed.shift)) < embree_range;
  return placed;
}

template <class EmbreeRays>
bool RayLoader::load(std::span<const Ray> rays, int lanes, Packet<EmbreeRays>& packet) const {
  QuadricContext& c = packet.context;
  float* const out = reinterpret_cast<float*>(&packet.rays);
  int traced = 0;
  for (int i = 0; i < lanes; ++i) {
    const bool present = static_cast<std::size_t>(i) < rays.size();
    const Ray& ray = rays[present ? static_cast<std::size_t>(i) : 0];
    const bool valid = is_valid(ray);
    Placed placed{0, 1, present && valid};
    if (valid && !is_ordinary(ray)) placed = place(ray), placed.traced &= present;
    packet.status[i] = valid ? status_miss : status_invalid;
    packet.valid[i] = placed.traced ? -1 : 0;
    c.scale[i] = placed.scale;
    c.rate[i] = 1 / placed.scale;
    traced += placed.traced;
    c.ox[i] = ray.origin.x, c.oy[i] = ray.origin.y, c.oz[i] = ray.origin.z;
    c.dx[i] = ray.direction.x, c.dy[i] = ray.direction.y, c.dz[i] = ray.direction.z;
    c.tmin[i] = ray.tmin;
    c.nearest[i] = next_above(ray.tmax);
    c.object[i] = 0;
    c.shift[i] = placed.shift;
    const glm::dvec3 origin = placed.shift == 0 ? ray.origin : ray.at(placed.shift);
    const auto field = [&](int f) -> float& { return out[f * lanes + i]; };
    field(0) = static_cast<float>(origin.x), field(1) = static_cast<float>(origin.y),
    field(2) = static_cast<float>(origin.z);
    field(3) = std::max(0.f, float_below((ray.tmin - placed.shift) / placed.scale));
    field(4) = static_cast<float>(ray.direction.x * placed.scale);
    field(5) = static_cast<float>(ray.direction.y * placed.scale);
    field(6) = static_cast<float>(ray.direction.z * placed.scale);
    field(7) = 0;
    field(8) = float_above((ray.tmax - placed.shift) / placed.scale);
    reinterpret_cast<unsigned&>(field(9)) = ~0u;
    reinterpret_cast<unsigned&>(field(10)) = static_cast<unsigned>(i);
    reinterpret_cast<unsigned&>(field(11)) = 0;
  }
  return traced > 0;
}

template bool RayLoader::load(std::span<const Ray>, int, Packet<RTCRayHit>&) const;
template bool RayLoader::load(std::span<const Ray>, int, Packet<RTCRayHit8>&) const;
template bool RayLoader::load(std::span<const Ray>, int, Packet<RTCRayHit16>&) const;
template bool RayLoader::load(std::span<const Ray>, int, Packet<RTCRay>&) const;
template bool RayLoader::load(std::span<const Ray>, int, Packet<RTCRay8>&) const;
template bool RayLoader::load(std::span<const Ray>, int, Packet<RTCRay16>&) const;

}  // namespace rayengine
