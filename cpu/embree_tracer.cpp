#include "cpu/embree_tracer.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <type_traits>

#include "accel/surface.h"
#include "cpu/embree_rays.h"
#include "cpu/embree_scene.h"

namespace rayengine {
namespace {

constexpr std::size_t grain = 1024;  // rays a task; batches up to this run on the calling thread

/// Where Embree's answer for one ray is found in a packet of `lanes`.
struct Answer {
  float t, u, v;
  glm::vec3 normal;  // of triangles; not unit
  unsigned geom, prim, inst;
};

template <class RayHits>
Answer answer(RayHits& packet, int lanes, int i) {
  auto* rays = reinterpret_cast<RTCRayHitN*>(&packet);
  RTCRayN* ray = RTCRayHitN_RayN(rays, static_cast<unsigned>(lanes));
  RTCHitN* hit = RTCRayHitN_HitN(rays, static_cast<unsigned>(lanes));
  const auto n = static_cast<unsigned>(lanes), k = static_cast<unsigned>(i);
  return {RTCRayN_tfar(ray, n, k),     RTCHitN_u(hit, n, k),
          RTCHitN_v(hit, n, k),        {RTCHitN_Ng_x(hit, n, k), RTCHitN_Ng_y(hit, n, k), RTCHitN_Ng_z(hit, n, k)},
          RTCHitN_geomID(hit, n, k),   RTCHitN_primID(hit, n, k),
          RTCHitN_instID(hit, n, k, 0)};
}

class EmbreeTracer final : public Tracer {
 public:
  EmbreeTracer(std::shared_ptr<const Geometry> geometry, Precision precision)
      : precision_(precision), scene_(std::move(geometry), precision), loader_(scene_, precision) {}

  std::string_view name() const override { return "embree"; }
  Precision precision() const override { return precision_; }
  double build_seconds() const override { return scene_.build_seconds(); }
  std::size_t bytes() const override { return scene_.bytes(); }
  Limits limits() const override {
    return {.triangle_roundoff = 0x1p-24, .quadric_roundoff = precision_ == Precision::fast ? 0x1p-24 : 0x1p-53};
  }

  void closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) override;
  void any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) override;
  HitLists all(std::span<const Ray> rays) override;

 private:
  template <class EmbreeRays>
  void begin(Packet<EmbreeRays>& packet, RayClass ray_class) const;
  template <class RayHits, int lanes>
  void closest_packets(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) const;
  template <class Rays, int lanes>
  void any_packets(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) const;
  std::vector<Hit> all(const Ray& ray) const;
  Hit hit(const Ray& ray, const Answer& answer, double t) const;
  void set_ids(Hit& hit, const Answer& answer, const EmbreeScene::Level& level, std::uint32_t object,
               std::uint32_t primitive) const;

  Precision precision_;
  EmbreeScene scene_;
  RayLoader loader_;
};

void check_sizes(std::size_t rays, std::size_t answers) {
  if (rays != answers) throw Error("a query needs as many answers as rays");
}

/// Coherent rays gain from packets; the others are traced one by one.
bool is_coherent(RayClass ray_class) { return ray_class != RayClass::bounce; }

template <class Work>
void for_ranges(std::size_t count, Work&& work) {
  if (count <= grain) return work(0, count);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, (count + grain - 1) / grain, 1),
                    [&](const auto& range) { work(range.begin() * grain, std::min(range.end() * grain, count)); });
}

template <class EmbreeRays>
void EmbreeTracer::begin(Packet<EmbreeRays>& packet, RayClass ray_class) const {
  rtcInitIntersectContext(&packet.context.embree);
  // Embree 3.13 can hang in its coherent occlusion test when the scene holds instances.
  if (is_coherent(ray_class) && scene_.instances().empty())
    packet.context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  packet.context.instances = &scene_.instances();
}

void EmbreeTracer::set_ids(Hit& hit, const Answer& answer, const EmbreeScene::Level& level, std::uint32_t object,
                           std::uint32_t primitive) const {
  if (answer.inst == RTC_INVALID_GEOMETRY_ID) {
    hit.object = object, hit.primitive = primitive;
    return;
  }
  const Instance& instance = scene_.instances()[answer.inst];
  hit.object = instance.object;
  hit.primitive = instance.first_primitive + level.geometry->objects[object].first_primitive + primitive;
}

Hit EmbreeTracer::hit(const Ray& ray, const Answer& answer, double t) const {
  const EmbreeScene::Level& level = scene_.level(answer.inst);
  const Geometry& g = *level.geometry;
  Hit result;
  result.t = t;
  result.status = status_hit;
  if (answer.geom == level.triangles_id) {
    result.u = answer.u, result.v = answer.v;
    const std::uint32_t object = g.triangle_object[answer.prim];
    set_ids(result, answer, level, object, answer.prim - g.objects[object].first);
    glm::dvec3 normal(answer.normal);
    if (answer.inst != RTC_INVALID_GEOMETRY_ID)
      normal = scene_.instances()[answer.inst].to_group.normal_to_world(normal);
    result.normal = glm::vec3(normal / std::sqrt((normal.x * normal.x + normal.y * normal.y) + normal.z * normal.z));
    return result;
  }
  const QuadricBucket& bucket = *level.buckets[answer.geom - level.first_bucket];
  const Quadric& quadric = g.quadrics[bucket.quadrics[answer.prim]];
  const auto part = static_cast<std::uint32_t>(answer.u);
  set_ids(result, answer, level, quadric.object, part);
  const Instance* instance = answer.inst == RTC_INVALID_GEOMETRY_ID ? nullptr : &scene_.instances()[answer.inst];
  result.normal = glm::vec3(quadric_normal(g, quadric, instance, part, ray.at(t)));
  return result;
}

template <class RayHits, int lanes>
void EmbreeTracer::closest_packets(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) const {
  Packet<RayHits> packet;
  begin(packet, ray_class);
  for (std::size_t first = 0; first < rays.size(); first += lanes) {
    const auto now = rays.subspan(first, std::min<std::size_t>(lanes, rays.size() - first));
    const bool traced = loader_.load(now, lanes, packet);
    auto* geom = &packet.rays.hit.geomID;
    std::fill_n(reinterpret_cast<unsigned*>(geom), lanes, RTC_INVALID_GEOMETRY_ID);
    std::fill_n(reinterpret_cast<unsigned*>(&packet.rays.hit.instID), lanes, RTC_INVALID_GEOMETRY_ID);
    if (traced) {
      if constexpr (lanes == 16) rtcIntersect16(packet.valid, scene_.scene(), &packet.context.embree, &packet.rays);
      if constexpr (lanes == 8) rtcIntersect8(packet.valid, scene_.scene(), &packet.context.embree, &packet.rays);
      if constexpr (lanes == 1) rtcIntersect1(scene_.scene(), &packet.context.embree, &packet.rays);
    }
    for (int i = 0; i < static_cast<int>(now.size()); ++i) {
      Hit& out = hits[first + static_cast<std::size_t>(i)];
      const Answer a = answer(packet.rays, lanes, i);
      if (a.geom == RTC_INVALID_GEOMETRY_ID || !packet.valid[i]) {
        out = Hit{};
        out.status = packet.status[i];
        continue;
      }
      const bool triangle = a.geom == scene_.level(a.inst).triangles_id;
      const double t = triangle || precision_ == Precision::fast
                           ? packet.context.shift[i] + static_cast<double>(a.t) * packet.context.scale[i]
                           : packet.context.nearest[i];
      out = hit(now[static_cast<std::size_t>(i)], a, t);
    }
  }
}

template <class Rays, int lanes>
void EmbreeTracer::any_packets(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) const {
  Packet<Rays> packet;
  begin(packet, ray_class);
  for (std::size_t first = 0; first < rays.size(); first += lanes) {
    const auto now = rays.subspan(first, std::min<std::size_t>(lanes, rays.size() - first));
    if (loader_.load(now, lanes, packet)) {
      if constexpr (lanes == 16) rtcOccluded16(packet.valid, scene_.scene(), &packet.context.embree, &packet.rays);
      if constexpr (lanes == 8) rtcOccluded8(packet.valid, scene_.scene(), &packet.context.embree, &packet.rays);
      if constexpr (lanes == 1) rtcOccluded1(scene_.scene(), &packet.context.embree, &packet.rays);
    }
    const float* tfar = reinterpret_cast<const float*>(&packet.rays.tfar);
    for (int i = 0; i < static_cast<int>(now.size()); ++i) {
      const bool occluded = packet.valid[i] && tfar[i] == -std::numeric_limits<float>::infinity();
      status[first + static_cast<std::size_t>(i)] = packet.status[i] | (occluded ? status_hit : status_miss);
    }
  }
}

void EmbreeTracer::closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) {
  check_sizes(rays.size(), hits.size());
  for_ranges(rays.size(), [&](std::size_t first, std::size_t last) {
    const auto some = rays.subspan(first, last - first);
    const auto out = hits.subspan(first, last - first);
    if (!is_coherent(ray_class)) return closest_packets<RTCRayHit, 1>(some, out, ray_class);
    if (scene_.native_packet() == 16) return closest_packets<RTCRayHit16, 16>(some, out, ray_class);
    closest_packets<RTCRayHit8, 8>(some, out, ray_class);
  });
}

void EmbreeTracer::any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) {
  check_sizes(rays.size(), status.size());
  for_ranges(rays.size(), [&](std::size_t first, std::size_t last) {
    const auto some = rays.subspan(first, last - first);
    const auto out = status.subspan(first, last - first);
    if (!is_coherent(ray_class)) return any_packets<RTCRay, 1>(some, out, ray_class);
    if (scene_.native_packet() == 16) return any_packets<RTCRay16, 16>(some, out, ray_class);
    any_packets<RTCRay8, 8>(some, out, ray_class);
  });
}

/// Embree's filter: keeps the hit and lets the ray go on.
void collect_triangle(const RTCFilterFunctionNArguments* args) {
  auto& context = *reinterpret_cast<QuadricContext*>(args->context);
  const unsigned n = args->N;
  const double t = context.shift[0] + static_cast<double>(RTCRayN_tfar(args->ray, n, 0)) * context.scale[0];
  if (t > context.tmin[0])
    collect_hit(*context.collector,
                {t, RTCHitN_geomID(args->hit, n, 0), RTCHitN_primID(args->hit, n, 0),
                 RTCHitN_instID(args->hit, n, 0, 0), RTCHitN_u(args->hit, n, 0), RTCHitN_v(args->hit, n, 0)});
  args->valid[0] = 0;
}

std::vector<Hit> EmbreeTracer::all(const Ray& ray) const {
  Packet<RTCRayHit> packet;
  begin(packet, RayClass::bounce);
  HitCollector collector;
  packet.context.collector = &collector;
  packet.context.embree.filter = collect_triangle;
  packet.rays.hit.geomID = packet.rays.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  if (loader_.load({&ray, 1}, 1, packet)) rtcIntersect1(scene_.scene(), &packet.context.embree, &packet.rays);
  std::vector<Hit> hits;
  for (const auto& e : collector.entries) {
    const EmbreeScene::Level& level = scene_.level(e.inst);
    glm::vec3 normal(0);
    if (e.geom == level.triangles_id) normal = glm::vec3(triangle_normal(*level.geometry, e.prim));
    const bool single = precision_ == Precision::fast && e.geom != level.triangles_id;  // Embree's own t
    const double t = single ? packet.context.shift[0] + e.t * packet.context.scale[0] : e.t;
    hits.push_back(hit(ray, {0, e.u, e.v, normal, e.geom, e.prim, e.inst}, t));
  }
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) {
    return std::tie(a.t, a.object, a.primitive) < std::tie(b.t, b.object, b.primitive);
  });
  return hits;
}

HitLists EmbreeTracer::all(std::span<const Ray> rays) {
  std::vector<std::vector<Hit>> lists(rays.size());
  for_ranges(rays.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) lists[i] = all(rays[i]);
  });
  HitLists result;
  result.offsets.push_back(0);
  for (const auto& list : lists) {
    result.hits.insert(result.hits.end(), list.begin(), list.end());
    result.offsets.push_back(result.hits.size());
  }
  return result;
}

}  // namespace

std::unique_ptr<Tracer> make_embree_tracer(std::shared_ptr<const Geometry> geometry, Precision precision) {
  if (precision != Precision::fast && precision != Precision::robust)
    throw Error("the embree tracer holds the precisions fast and robust, not " + std::string(to_string(precision)));
  return std::make_unique<EmbreeTracer>(std::move(geometry), precision);
}

}  // namespace rayengine
