#include "cpu/bare_embree.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "accel/stopwatch.h"
#include "accel/tracer.h"
#include "cpu/round_sphere.h"

namespace rayengine {
namespace {

template <int N>
struct Packet;
template <>
struct Packet<4> {
  using Rays = RTCRay4;
  using RayHits = RTCRayHit4;
  static constexpr auto intersect = rtcIntersect4;
  static constexpr auto occluded = rtcOccluded4;
};
template <>
struct Packet<8> {
  using Rays = RTCRay8;
  using RayHits = RTCRayHit8;
  static constexpr auto intersect = rtcIntersect8;
  static constexpr auto occluded = rtcOccluded8;
};
template <>
struct Packet<16> {
  using Rays = RTCRay16;
  using RayHits = RTCRayHit16;
  static constexpr auto intersect = rtcIntersect16;
  static constexpr auto occluded = rtcOccluded16;
};

RTCRay to_embree(const Ray& ray) {
  RTCRay out{};
  out.org_x = static_cast<float>(ray.origin.x), out.org_y = static_cast<float>(ray.origin.y);
  out.org_z = static_cast<float>(ray.origin.z), out.tnear = static_cast<float>(ray.tmin);
  out.dir_x = static_cast<float>(ray.direction.x), out.dir_y = static_cast<float>(ray.direction.y);
  out.dir_z = static_cast<float>(ray.direction.z), out.tfar = static_cast<float>(ray.tmax);
  out.mask = ~0u;
  return out;
}

template <class Rays>
void put(Rays& rays, std::size_t lane, const RTCRay& ray) {
  rays.org_x[lane] = ray.org_x, rays.org_y[lane] = ray.org_y, rays.org_z[lane] = ray.org_z;
  rays.dir_x[lane] = ray.dir_x, rays.dir_y[lane] = ray.dir_y, rays.dir_z[lane] = ray.dir_z;
  rays.tnear[lane] = ray.tnear, rays.tfar[lane] = ray.tfar;
  rays.time[lane] = 0, rays.mask[lane] = ~0u, rays.id[lane] = 0, rays.flags[lane] = 0;
}

/// Fills the lanes of a packet from up to N rays.
template <int N, class Rays>
void fill(std::span<const Ray> rays, int (&valid)[N], Rays& packet) {
  for (std::size_t lane = 0; lane < N; ++lane) {
    valid[lane] = lane < rays.size() ? -1 : 0;
    if (valid[lane]) put(packet, lane, to_embree(rays[lane]));
  }
}

template <int N>
void closest_packets(RTCScene scene, RTCIntersectContext& context, std::span<const Ray> rays, std::span<BareHit> hits) {
  alignas(64) int valid[N];
  alignas(64) typename Packet<N>::RayHits packet;
  for (std::size_t first = 0; first < rays.size(); first += N) {
    const std::size_t count = std::min<std::size_t>(N, rays.size() - first);
    fill(rays.subspan(first, count), valid, packet.ray);
    std::fill(packet.hit.geomID, packet.hit.geomID + N, RTC_INVALID_GEOMETRY_ID);
    std::fill(packet.hit.instID[0], packet.hit.instID[0] + N, RTC_INVALID_GEOMETRY_ID);
    Packet<N>::intersect(valid, scene, &context, &packet);
    for (std::size_t lane = 0; lane < count; ++lane)
      hits[first + lane] = {packet.ray.tfar[lane], packet.hit.u[lane], packet.hit.v[lane], packet.hit.geomID[lane],
                            packet.hit.primID[lane]};
  }
}

template <int N>
void any_packets(RTCScene scene, RTCIntersectContext& context, std::span<const Ray> rays,
                 std::span<std::uint32_t> status) {
  alignas(64) int valid[N];
  alignas(64) typename Packet<N>::Rays packet;
  for (std::size_t first = 0; first < rays.size(); first += N) {
    const std::size_t count = std::min<std::size_t>(N, rays.size() - first);
    fill(rays.subspan(first, count), valid, packet);
    Packet<N>::occluded(valid, scene, &context, &packet);
    for (std::size_t lane = 0; lane < count; ++lane)
      status[first + lane] = packet.tfar[lane] < 0 ? status_hit : status_miss;
  }
}

void closest_singles(RTCScene scene, RTCIntersectContext& context, std::span<const Ray> rays, std::span<BareHit> hits) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    alignas(16) RTCRayHit one{to_embree(rays[i]), {}};
    one.hit.geomID = one.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &context, &one);
    hits[i] = {one.ray.tfar, one.hit.u, one.hit.v, one.hit.geomID, one.hit.primID};
  }
}

void any_singles(RTCScene scene, RTCIntersectContext& context, std::span<const Ray> rays,
                 std::span<std::uint32_t> status) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    alignas(16) RTCRay one = to_embree(rays[i]);
    rtcOccluded1(scene, &context, &one);
    status[i] = one.tfar < 0 ? status_hit : status_miss;
  }
}

RTCIntersectContext context_for(bool coherent) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}

bool count_memory(void* total, ssize_t bytes, bool) {
  *static_cast<std::atomic<ssize_t>*>(total) += bytes;
  return true;
}

}  // namespace

struct BareEmbree::Impl {
  explicit Impl(std::shared_ptr<const Geometry> from) : geometry(std::move(from)) {
    rtcSetDeviceMemoryMonitorFunction(device, count_memory, &bytes);
  }
  ~Impl() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }

  void add(std::span<const glm::vec3> vertices, std::span<const glm::uvec3> triangles);
  void add_spheres();
  void attach(RTCGeometry made);
  void commit(bool robust);
  void check() const;
  int width() const;

  std::shared_ptr<const Geometry> geometry;
  std::atomic<ssize_t> bytes = 0;
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = rtcNewScene(device);
  double build_seconds = 0;
  bool triangles_first = false;  ///< geometry 0 holds our triangles
  int packet_width = 0;
};

void BareEmbree::Impl::check() const {
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE)
    throw Error("Embree could not build the yardstick's scene: is there enough memory?");
}

void BareEmbree::Impl::attach(RTCGeometry made) {
  rtcCommitGeometry(made);
  rtcAttachGeometry(scene, made);
  rtcReleaseGeometry(made);
}

void BareEmbree::Impl::add(std::span<const glm::vec3> vertices, std::span<const glm::uvec3> triangles) {
  const RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* points =
      rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), vertices.size());
  void* indices =
      rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), triangles.size());
  check();
  std::ranges::copy(vertices, static_cast<glm::vec3*>(points));
  std::ranges::copy(triangles, static_cast<glm::uvec3*>(indices));
  attach(mesh);
}

void BareEmbree::Impl::add_spheres() {
  const RTCGeometry points = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  auto* at = static_cast<glm::vec4*>(rtcSetNewGeometryBuffer(points, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                                             sizeof(glm::vec4), geometry->quadrics.size()));
  check();
  for (const Quadric& quadric : geometry->quadrics) {
    const RoundSphere sphere = *round_sphere(quadric);
    *at++ = glm::vec4(glm::vec3(sphere.center), static_cast<float>(sphere.radius));
  }
  attach(points);
}

void BareEmbree::Impl::commit(bool robust) {
  rtcSetSceneFlags(scene, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
  const Stopwatch watch;
  rtcCommitScene(scene);
  build_seconds = watch.seconds();
  check();
  packet_width = width();
}

int BareEmbree::Impl::width() const {
  if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) return 16;
  return rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) ? 8 : 4;
}

bool BareEmbree::holds(const Geometry& geometry, BareShape shape) {
  if (!geometry.instances.empty()) return false;
  if (shape == BareShape::triangles) return geometry.quadrics.empty() && !geometry.triangles.empty();
  if (geometry.quadrics.empty()) return false;
  return std::ranges::all_of(geometry.quadrics,
                             [](const Quadric& quadric) { return round_sphere(quadric).has_value(); });
}

BareEmbree::BareEmbree(std::shared_ptr<const Geometry> geometry, BareShape shape, bool robust)
    : impl_(std::make_unique<Impl>(std::move(geometry))) {
  const Geometry& g = *impl_->geometry;
  impl_->triangles_first = !g.triangles.empty();
  if (impl_->triangles_first) impl_->add(g.vertices, g.triangles);
  if (shape == BareShape::spheres) impl_->add_spheres();
  impl_->commit(robust);
}
BareEmbree::~BareEmbree() = default;

double BareEmbree::build_seconds() const { return impl_->build_seconds; }
std::size_t BareEmbree::bytes() const { return static_cast<std::size_t>(impl_->bytes.load()); }

void BareEmbree::closest(std::span<const Ray> rays, std::span<BareHit> hits, RayClass ray_class) const {
  RTCIntersectContext context = context_for(ray_class != RayClass::bounce);
  if (ray_class == RayClass::bounce) return closest_singles(impl_->scene, context, rays, hits);
  switch (impl_->packet_width) {
    case 16: return closest_packets<16>(impl_->scene, context, rays, hits);
    case 8: return closest_packets<8>(impl_->scene, context, rays, hits);
    default: return closest_packets<4>(impl_->scene, context, rays, hits);
  }
}

void BareEmbree::any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) const {
  RTCIntersectContext context = context_for(ray_class != RayClass::bounce);
  if (ray_class == RayClass::bounce) return any_singles(impl_->scene, context, rays, status);
  switch (impl_->packet_width) {
    case 16: return any_packets<16>(impl_->scene, context, rays, status);
    case 8: return any_packets<8>(impl_->scene, context, rays, status);
    default: return any_packets<4>(impl_->scene, context, rays, status);
  }
}

Hit BareEmbree::hit(const BareHit& bare) const {
  Hit hit;
  if (bare.geometry == RTC_INVALID_GEOMETRY_ID) return hit;
  const Geometry& g = *impl_->geometry;
  hit.t = bare.t, hit.status = status_hit;
  if (impl_->triangles_first && bare.geometry == 0) {
    hit.object = g.triangle_object[bare.primitive];
    hit.primitive = bare.primitive - g.objects[hit.object].first;
    hit.u = bare.u, hit.v = bare.v;
  } else {
    hit.object = g.quadrics[bare.primitive].object;
    hit.primitive = 0;
  }
  return hit;
}

}  // namespace rayengine
