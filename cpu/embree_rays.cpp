#include "cpu/embree_rays.h"

#include <algorithm>
#include <bit>
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

bool has_quadrics(const Geometry& geometry) {
  return !geometry.quadrics.empty() ||
         std::ranges::any_of(geometry.groups, [](const auto& group) { return has_quadrics(*group); });
}

}  // namespace

RayLoader::RayLoader(const EmbreeScene& scene, Precision precision)
    : scene_(scene),
      code_(packet_code(best_isa())),
      ordinary_{EmbreeScene::range, shortest, longest},
      box_(scene.finite_bounds()),
      moves_(precision != Precision::fast && !box_.empty()),
      unbounded_(!scene.geometry().bounds.finite()),
      reads_context_(precision != Precision::fast && has_quadrics(scene.geometry())) {
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

bool RayLoader::load_lane(const Ray& ray, int lanes, int lane, QuadricContext& c, float* numbers,
                          std::uint32_t& status) const {
  Placed placed;
  if (!is_ordinary(ray)) {
    if (!is_valid(ray)) return status = status_invalid, false;
    placed = place(ray);
    if (!placed.traced) return false;
  }
  c.ox[lane] = ray.origin.x, c.oy[lane] = ray.origin.y, c.oz[lane] = ray.origin.z;
  c.dx[lane] = ray.direction.x, c.dy[lane] = ray.direction.y, c.dz[lane] = ray.direction.z;
  c.tmin[lane] = ray.tmin;
  c.nearest[lane] = next_above(ray.tmax);
  c.object[lane] = 0;
  c.shift[lane] = placed.shift;
  c.rate[lane] = placed.rate;
  c.scale[lane] = placed.scale;
  const glm::dvec3 origin = placed.shift == 0 ? ray.origin : ray.at(placed.shift);
  float* const field = numbers + lane;
  for (int i = 0; i < 3; ++i) {
    field[(org_x_row + i) * lanes] = static_cast<float>(origin[i]);
    field[(dir_x_row + i) * lanes] = static_cast<float>(ray.direction[i] * placed.scale);
  }
  field[tnear_row * lanes] = std::max(0.f, float_below((ray.tmin - placed.shift) * placed.rate));
  field[tfar_row * lanes] = float_above((ray.tmax - placed.shift) * placed.rate);
  return true;
}

void RayLoader::begin(bool coherent, int lanes, QuadricContext& context, float* numbers) const {
  rtcInitIntersectContext(&context.embree);
  // Embree 3.13 can hang in its coherent occlusion test when the scene holds instances.
  if (coherent && scene_.instances().empty()) context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  context.instances = &scene_.instances();
  std::fill_n(numbers + time_row * lanes, lanes, 0.f);
  std::fill_n(numbers + mask_row * lanes, lanes, std::bit_cast<float>(~0u));
  std::fill_n(numbers + id_row * lanes, 2 * lanes, 0.f);  // and flags
}

void RayLoader::begin(bool coherent, Packet& packet) const {
  packet.lanes = scene_.native_packet();
  begin(coherent, packet.lanes, packet.context, packet.numbers);
}

bool RayLoader::load_ordinary(std::span<const Ray> rays, Packet& packet) const {
  const auto lanes = static_cast<std::size_t>(packet.lanes);
  if (rays.size() < lanes) {
    Ray padded[packet_size];
    std::fill(std::ranges::copy(rays, padded).out, padded + lanes, rays.back());
    return load_ordinary({padded, lanes}, packet);
  }
  return code_.load(ordinary_, rays.data(), packet.lanes, reads_context_ ? &packet.context : nullptr, packet.numbers);
}

bool RayLoader::load(std::span<const Ray> rays, Packet& packet) const {
  const int lanes = packet.lanes, count = static_cast<int>(rays.size());
  std::fill_n(packet.status, lanes, status_miss);
  packet.odd = !load_ordinary(rays, packet);
  if (!packet.odd) {
    std::fill(std::fill_n(packet.valid, count, -1), packet.valid + lanes, 0);
    return true;
  }
  std::fill_n(packet.valid, lanes, 0);
  bool any = false;
  for (int i = 0; i < count; ++i) {
    const bool traced =
        load_lane(rays[static_cast<std::size_t>(i)], lanes, i, packet.context, packet.numbers, packet.status[i]);
    packet.valid[i] = traced ? -1 : 0;
    any |= traced;
  }
  return any;
}

bool RayLoader::load(const Ray& ray, Single& single) const {
  auto* const numbers = reinterpret_cast<float*>(&single.ray);
  begin(false, 1, single.context, numbers);
  single.ray.hit.geomID = single.ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  std::uint32_t status;
  return load_lane(ray, 1, 0, single.context, numbers, status);
}

}  // namespace rayengine
