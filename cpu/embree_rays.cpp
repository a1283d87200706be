#include "cpu/embree_rays.h"

#include <algorithm>
#include <cmath>

#include "accel/rounding.h"

namespace rayengine {
namespace {

// Single precision directions outside of this would overflow or lose bits when they are multiplied.
constexpr double longest = 1e15, shortest = 1e-15;

double absolute_sum(const glm::dvec3& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

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
    : scene_(scene),
      load_packet_(packet_loader(best_isa())),
      ordinary_{EmbreeScene::range, shortest, longest},
      box_(scene.finite_bounds()),
      moves_(precision != Precision::fast && !box_.empty()),
      unbounded_(!scene.geometry().bounds.finite()) {
  if (box_.empty()) return;
  if (moves_) ordinary_.farthest = box_.extent() * EmbreeScene::near_extents;
  const double slack = box_.extent() * 0x1p-20;  // room for the rounding of the entry point itself
  box_ = {box_.lower - slack, box_.upper + slack};
}

bool RayLoader::is_ordinary(const Ray& ray) const {
  const double o = absolute_sum(ray.origin), d = absolute_sum(ray.direction);
  return o <= ordinary_.farthest && d >= ordinary_.shortest && d <= ordinary_.longest && ray.tmin >= 0 &&
         ray.tmin <= ray.tmax;
}

RayLoader::Placed RayLoader::place(const Ray& ray) const {
  Placed placed;
  const double length = absolute_sum(ray.direction);
  if (!(length <= longest && length >= shortest))
    placed.scale = std::ldexp(1.0, -std::ilogb(length)), placed.rate = 1 / placed.scale;
  double enter = ray.tmin, leave = ray.tmax;
  for (int axis = 0; axis < 3; ++axis)
    clip(box_.lower[axis], box_.upper[axis], ray.origin[axis], ray.direction[axis], enter, leave);
  const bool misses = enter > leave;
  if (moves_ && !misses && std::isfinite(enter))
    placed.shift = enter;
  else if (std::isfinite(ray.tmin))
    placed.shift = std::min(ray.tmin, 0.0);
  placed.traced = (!misses || unbounded_) && absolute_sum(ray.at(placed.shift)) < EmbreeScene::range;
  return placed;
}

void RayLoader::load_lane(const Ray& ray, const Placed& placed, int lanes, int lane, QuadricContext& c,
                          float* soa) const {
  c.ox[lane] = ray.origin.x, c.oy[lane] = ray.origin.y, c.oz[lane] = ray.origin.z;
  c.dx[lane] = ray.direction.x, c.dy[lane] = ray.direction.y, c.dz[lane] = ray.direction.z;
  c.tmin[lane] = ray.tmin;
  c.nearest[lane] = next_above(ray.tmax);
  c.object[lane] = 0;
  c.shift[lane] = placed.shift;
  c.rate[lane] = placed.rate;
  c.scale[lane] = placed.scale;
  const glm::dvec3 origin = placed.shift == 0 ? ray.origin : ray.at(placed.shift);
  float* const field = soa + lane;
  for (int i = 0; i < 3; ++i) {
    field[i * lanes] = static_cast<float>(origin[i]);
    field[(4 + i) * lanes] = static_cast<float>(ray.direction[i] * placed.scale);
  }
  field[3 * lanes] = std::max(0.f, float_below((ray.tmin - placed.shift) * placed.rate));
  field[8 * lanes] = float_above((ray.tmax - placed.shift) * placed.rate);
}

template <class EmbreeRays>
void RayLoader::begin(int lanes, bool coherent, Packet<EmbreeRays>& packet) const {
  rtcInitIntersectContext(&packet.context.embree);
  // Embree 3.13 can hang in its coherent occlusion test when the scene holds instances.
  if (coherent && scene_.instances().empty()) packet.context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  packet.context.instances = &scene_.instances();
  float* const soa = reinterpret_cast<float*>(&packet.rays);
  std::fill_n(soa + 7 * lanes, lanes, 0.f);                                   // time
  std::fill_n(reinterpret_cast<unsigned*>(soa + 9 * lanes), lanes, ~0u);      // mask
  std::fill_n(reinterpret_cast<unsigned*>(soa + 10 * lanes), 2 * lanes, 0u);  // id, flags
}

template <class EmbreeRays>
bool RayLoader::load(std::span<const Ray> rays, int lanes, Packet<EmbreeRays>& packet) const {
  float* const soa = reinterpret_cast<float*>(&packet.rays);
  const int count = static_cast<int>(rays.size());
  if (lanes > 1 && count == lanes && load_packet_(ordinary_, rays.data(), lanes, packet.context, soa)) {
    std::fill_n(packet.valid, lanes, -1);
    std::fill_n(packet.status, lanes, status_miss);
    return true;
  }
  bool any = false;
  std::fill_n(packet.valid, lanes, 0);
  for (int i = 0; i < count; ++i) {
    const Ray& ray = rays[static_cast<std::size_t>(i)];
    Placed placed;
    packet.status[i] = status_miss;
    if (!is_ordinary(ray)) {
      const bool valid = is_valid(ray);
      packet.status[i] = valid ? status_miss : status_invalid;
      placed = valid ? place(ray) : Placed{.traced = false};
    }
    packet.valid[i] = placed.traced ? -1 : 0;
    any |= placed.traced;
    if (placed.traced) load_lane(ray, placed, lanes, i, packet.context, soa);
  }
  return any;
}

template void RayLoader::begin(int, bool, Packet<RTCRayHit>&) const;
template bool RayLoader::load(std::span<const Ray>, int, Packet<RTCRayHit>&) const;
template void RayLoader::begin(int, bool, Packet<RTCRayHit8>&) const;
template bool RayLoader::load(std::span<const Ray>, int, Packet<RTCRayHit8>&) const;
template void RayLoader::begin(int, bool, Packet<RTCRayHit16>&) const;
template bool RayLoader::load(std::span<const Ray>, int, Packet<RTCRayHit16>&) const;
template void RayLoader::begin(int, bool, Packet<RTCRay>&) const;
template bool RayLoader::load(std::span<const Ray>, int, Packet<RTCRay>&) const;
template void RayLoader::begin(int, bool, Packet<RTCRay8>&) const;
template bool RayLoader::load(std::span<const Ray>, int, Packet<RTCRay8>&) const;
template void RayLoader::begin(int, bool, Packet<RTCRay16>&) const;
template bool RayLoader::load(std::span<const Ray>, int, Packet<RTCRay16>&) const;

}  // namespace rayengine
