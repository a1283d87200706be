#include "cpu/embree_tracer.h"

#include <algorithm>
#include <bit>
#include <glm/geometric.hpp>
#include <mutex>

#include "accel/surface.h"
#include "cpu/embree_hits.h"
#include "cpu/embree_rays.h"
#include "cpu/embree_scene.h"
#include "cpu/ranges.h"

namespace rayengine {
namespace {

class EmbreeTracer final : public Tracer {
 public:
  EmbreeTracer(std::shared_ptr<const Geometry> geometry, Precision precision, Build build)
      : precision_(precision),
        build_(build),
        geometry_(std::move(geometry)),
        scene_(geometry_, precision, build),
        loader_(scene_, precision),
        maker_(scene_) {}

  std::string_view name() const override { return "embree"; }
  Precision precision() const override { return precision_; }
  double build_seconds() const override { return scene_.build_seconds(); }
  std::size_t bytes() const override { return scene_.bytes() + (filtering_ ? filtering_->bytes() : 0); }
  Limits limits() const override {
    return {.batch = 2048,
            .triangle_roundoff = 0x1p-24,
            .quadric_roundoff = precision_ == Precision::fast ? 0x1p-24 : 0x1p-53};
  }

  void closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) override;
  void any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) override;
  HitLists all(std::span<const Ray> rays) override;

 private:
  void closest_packets(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) const;
  void any_packets(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) const;
  void intersect(Packet& packet) const;
  void intersect_alone(Packet& packet) const;
  void occluded(Packet& packet) const;
  void occluded_alone(Packet& packet) const;
  void store(std::span<const Ray> rays, const Packet& packet, Hit* hits) const;
  void finish(const Packet& packet, int lane, Hit& hit) const;
  std::vector<Hit> all(const Ray& ray) const;

  Precision precision_;
  Build build_;
  std::shared_ptr<const Geometry> geometry_;
  EmbreeScene scene_;
  std::unique_ptr<EmbreeScene> filtering_;  ///< the same with the same ids, made by the first all-hits query
  std::once_flag filtering_once_;
  RayLoader loader_;
  EmbreeHits maker_;
  const PacketCode& code_ = packet_code(best_isa());
  bool instances_ = !scene_.instances().empty();
  bool ids_are_known_ = maker_.ids_are_known();
};

/// Primary and shadow rays are coherent as they come.
bool is_coherent(RayClass ray_class) { return ray_class != RayClass::bounce; }

/// Has what comes next brought near while the packet before it is traced.
template <class T>
void fetch(std::span<T> next) {
  for (T& item : next) __builtin_prefetch(&item, !std::is_const_v<T>);
}

template <class T>
std::span<T> packet_at(std::span<T> all, std::size_t first, std::size_t lanes) {
  return first < all.size() ? all.subspan(first, std::min(lanes, all.size() - first)) : std::span<T>();
}

constexpr float no_geometry = std::bit_cast<float>(RTC_INVALID_GEOMETRY_ID);

void EmbreeTracer::intersect(Packet& p) const {
  if (p.lanes == 16)
    rtcIntersect16(p.valid, scene_.scene(), &p.context.embree, reinterpret_cast<RTCRayHit16*>(p.numbers));
  else
    rtcIntersect8(p.valid, scene_.scene(), &p.context.embree, reinterpret_cast<RTCRayHit8*>(p.numbers));
}

void EmbreeTracer::occluded(Packet& p) const {
  if (p.lanes == 16)
    rtcOccluded16(p.valid, scene_.scene(), &p.context.embree, reinterpret_cast<RTCRay16*>(p.numbers));
  else
    rtcOccluded8(p.valid, scene_.scene(), &p.context.embree, reinterpret_cast<RTCRay8*>(p.numbers));
}

void EmbreeTracer::intersect_alone(Packet& p) const {
  loader_.trace_alone(
      p, [&](RTCIntersectContext* context, RTCRayHit* ray) { rtcIntersect1(scene_.scene(), context, ray); });
}

void EmbreeTracer::occluded_alone(Packet& p) const {
  loader_.trace_alone(
      p, [&](RTCIntersectContext* context, RTCRayHit* ray) { rtcOccluded1(scene_.scene(), context, &ray->ray); });
}

/// A hit that was stored without a look at the scene becomes what it is.
void EmbreeTracer::finish(const Packet& p, int lane, Hit& hit) const {
  const auto id = [&](int row) { return std::bit_cast<unsigned>(p.row(row)[lane]); };
  const EmbreeIds ids{id(geom_row), id(prim_row), id(inst_row)};
  if (ids.geom == RTC_INVALID_GEOMETRY_ID) {
    hit.status = p.status[lane];
    return;
  }
  const bool triangle = maker_.is_triangle(ids), embrees_t = triangle || precision_ == Precision::fast;
  if (!embrees_t)
    hit.t = p.context.nearest[lane];
  else if (p.odd)
    hit.t = p.context.shift[lane] + hit.t * p.context.scale[lane];
  if (triangle)
    maker_.finish_triangle(ids, hit);
  else if (instances_)
    maker_.finish_quadric(ids, hit);
}

void EmbreeTracer::store(std::span<const Ray> rays, const Packet& p, Hit* hits) const {
  const EmbreeScene::Level& top = scene_.level(RTC_INVALID_GEOMETRY_ID);
  // What of a group was hit is not told by its geomID.
  const QuadricRows rows{top.first_bucket, precision_ == Precision::fast ? nullptr : p.context.nearest};
  const QuadricRows* quadrics = instances_ || top.buckets.empty() ? nullptr : &rows;
  if (rays.size() < static_cast<std::size_t>(p.lanes)) {
    Hit all[packet_size];
    code_.store(p.numbers, p.lanes, top.only_mesh, quadrics, all);
    std::copy_n(all, rays.size(), hits);
  } else {
    code_.store(p.numbers, p.lanes, top.only_mesh, quadrics, hits);
  }
  if (ids_are_known_ && !p.odd) return;
  for (std::size_t i = 0; i < rays.size(); ++i) finish(p, static_cast<int>(i), hits[i]);
}

void EmbreeTracer::closest_packets(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) const {
  Packet packet;
  loader_.begin(is_coherent(ray_class), packet);
  const auto lanes = static_cast<std::size_t>(packet.lanes);
  for (std::size_t first = 0; first < rays.size(); first += lanes) {
    const auto now = packet_at(rays, first, lanes);
    fetch(packet_at(rays, first + lanes, lanes));
    fetch(packet_at(hits, first, lanes));
    std::fill_n(packet.row(geom_row), 2 * lanes, no_geometry);  // and instances
    if (loader_.load(now, packet)) {
      if (is_coherent(ray_class) || (!packet.odd && code_.keep_together(packet.numbers, packet.lanes)))
        intersect(packet);
      else
        intersect_alone(packet);
    }
    store(now, packet, &hits[first]);
  }
}

void EmbreeTracer::any_packets(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) const {
  Packet packet;
  loader_.begin(true, packet);
  const bool coherent = is_coherent(ray_class);
  const auto lanes = static_cast<std::size_t>(packet.lanes);
  for (std::size_t first = 0; first < rays.size(); first += lanes) {
    const auto now = packet_at(rays, first, lanes);
    fetch(packet_at(rays, first + lanes, lanes));
    if (loader_.load(now, packet)) {
      if (coherent || (!packet.odd && code_.keep_together(packet.numbers, packet.lanes)))
        occluded(packet);
      else
        occluded_alone(packet);
    }
    const float* tfar = packet.row(tfar_row);
    for (std::size_t i = 0; i < now.size(); ++i) {
      const bool occluded = (packet.valid[i] != 0) & (tfar[i] == -std::numeric_limits<float>::infinity());
      status[first + i] = packet.status[i] | (occluded * status_hit);
    }
  }
}

void EmbreeTracer::closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) {
  check_lengths(rays.size(), hits.size());
  for_ranges(rays.size(), [&](std::size_t first, std::size_t last) {
    closest_packets(rays.subspan(first, last - first), hits.subspan(first, last - first), ray_class);
  });
}

void EmbreeTracer::any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) {
  check_lengths(rays.size(), status.size());
  for_ranges(rays.size(), [&](std::size_t first, std::size_t last) {
    any_packets(rays.subspan(first, last - first), status.subspan(first, last - first), ray_class);
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
  Single single;
  HitCollector collector;
  const bool traced = loader_.load(ray, single);
  single.context.collector = &collector;
  single.context.embree.filter = collect_triangle;
  if (traced) rtcIntersect1(filtering_->scene(), &single.context.embree, &single.ray);
  std::vector<Hit> hits;
  for (const auto& e : collector.entries) {
    const EmbreeIds ids{e.geom, e.prim, e.inst};
    Hit& hit = hits.emplace_back(Hit{.t = e.t, .u = e.u, .v = e.v});
    if (!maker_.is_triangle(ids)) {
      maker_.quadric(ray, ids, e.u, e.t, hit);
      continue;
    }
    hit.normal = glm::vec3(glm::normalize(triangle_normal(*scene_.level(e.inst).geometry, e.prim)));
    maker_.finish_triangle(ids, hit);
  }
  sort_hits(hits);
  return hits;
}

HitLists EmbreeTracer::all(std::span<const Ray> rays) {
  std::call_once(filtering_once_,
                 [&] { filtering_ = std::make_unique<EmbreeScene>(geometry_, precision_, build_, true); });
  return all_lists(rays.size(), [&](std::size_t i) { return all(rays[i]); });
}

}  // namespace

std::unique_ptr<Tracer> make_embree_tracer(std::shared_ptr<const Geometry> geometry, Precision precision, Build build) {
  if (precision != Precision::fast && precision != Precision::robust)
    throw Error("the embree tracer holds the precisions fast and robust, not " + std::string(to_string(precision)));
  return std::make_unique<EmbreeTracer>(std::move(geometry), precision, build);
}

}  // namespace rayengine
