#include "cpu/embree_tracer.h"

#include <algorithm>
#include <bit>
#include <glm/geometric.hpp>
#include <mutex>
#include <type_traits>

#include "accel/surface.h"
#include "cpu/embree_rays.h"
#include "cpu/embree_scene.h"
#include "cpu/ranges.h"

namespace rayengine {
namespace {

/// Embree's answer for one ray.
struct Answer {
  float t, u, v;
  glm::vec3 normal;  // of triangles; not unit
  unsigned geom, prim, inst;
};

/// Reads lane `i` of Embree's packet, fields of `lanes` numbers.
Answer answer(const float* soa, int lanes, int i) {
  const auto field = [&](int f) { return soa[f * lanes + i]; };
  const auto id = [&](int f) { return std::bit_cast<unsigned>(soa[f * lanes + i]); };
  return {field(8), field(15), field(16), {field(12), field(13), field(14)}, id(18), id(17), id(19)};
}

void forget_hits(float* soa, int lanes) {
  std::fill_n(soa + 18 * lanes, 2 * lanes, std::bit_cast<float>(RTC_INVALID_GEOMETRY_ID));
}

bool any_hit(const float* soa, int lanes) {
  const float* geom = soa + 18 * lanes;
  return std::any_of(geom, geom + lanes,
                     [](float id) { return std::bit_cast<unsigned>(id) != RTC_INVALID_GEOMETRY_ID; });
}

/// Normals of triangles to unit length, all lanes at once; lanes without a hit hold anything.
void normalise(float* soa, int lanes) {
  constexpr float least = std::numeric_limits<float>::min();
  float *x = soa + 12 * lanes, *y = x + lanes, *z = y + lanes;
  for (int i = 0; i < lanes; ++i) {
    const float largest = std::max(std::max(std::abs(x[i]), std::abs(y[i])), std::abs(z[i]));
    const float scale = largest > 1e-15f && largest < 1e15f ? 1 : 1 / std::max(largest, least);  // squares would vanish
    const float a = x[i] * scale, b = y[i] * scale, c = z[i] * scale;
    const float per_length = 1 / std::sqrt((a * a + b * b) + c * c);
    x[i] = a * per_length, y[i] = b * per_length, z[i] = c * per_length;
  }
}

class EmbreeTracer final : public Tracer {
 public:
  EmbreeTracer(std::shared_ptr<const Geometry> geometry, Precision precision)
      : precision_(precision),
        geometry_(std::move(geometry)),
        scene_(geometry_, precision),
        loader_(scene_, precision) {}

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
  template <class RayHits, int lanes>
  void closest_packets(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) const;
  template <class Rays, int lanes>
  void any_packets(std::span<const Ray> rays, std::span<std::uint32_t> status) const;
  std::vector<Hit> all(const Ray& ray) const;
  // These write to their last argument in place: copies of a hit cost as much as making it.
  void triangle_hit(const Answer& answer, const EmbreeScene::Level& level, double t, Hit& hit) const;
  void quadric_hit(const Ray& ray, const Answer& answer, const EmbreeScene::Level& level, double t, Hit& hit) const;
  void hit_of(const Ray& ray, const Answer& answer, const QuadricContext& context, int lane, Hit& hit) const;
  /// Ids within `level` to those that the caller knows.
  void set_ids(Hit& hit, unsigned inst, const EmbreeScene::Level& level, std::uint32_t object,
               std::uint32_t primitive) const;

  Precision precision_;
  std::shared_ptr<const Geometry> geometry_;
  EmbreeScene scene_;
  std::unique_ptr<EmbreeScene> filtering_;  ///< the same with the same ids, made by the first all-hits query
  std::once_flag filtering_once_;
  RayLoader loader_;
  /// Tests of triangles are so cheap that shadow rays gain from packets even where they part.
  bool mostly_triangles_ = geometry_->triangles.size() > geometry_->quadrics.size();
};

/// Primary and shadow rays are coherent as they come.
bool is_coherent(RayClass ray_class) { return ray_class != RayClass::bounce; }

double absolute_sum(const glm::dvec3& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

/// Rays into one octant visit a tree in the same order: they gain from packets whatever made them, unless they spread
/// over all of it.
bool keep_together(std::span<const Ray> rays) {
  const auto octant = [](const Ray& r) {
    return (r.direction.x < 0) | (r.direction.y < 0) << 1 | (r.direction.z < 0) << 2;
  };
  const glm::dvec3& first = rays[0].direction;
  const double spread = 0.8 * absolute_sum(first);
  return std::all_of(rays.begin(), rays.end(), [&](const Ray& r) {
    return octant(r) == octant(rays[0]) && absolute_sum(r.direction - first) < spread;
  });
}

/// Calls `together` or `alone` for runs of rays, whole packets each, as their directions have it.
template <class Together, class Alone>
void for_runs(std::span<const Ray> rays, std::size_t lanes, Together&& together, Alone&& alone) {
  const auto packet = [&](std::size_t first) { return rays.subspan(first, std::min(lanes, rays.size() - first)); };
  for (std::size_t first = 0, end; first < rays.size(); first = end) {
    const bool coherent = keep_together(packet(first));
    for (end = first + lanes; end < rays.size() && keep_together(packet(end)) == coherent;) end += lanes;
    end = std::min(end, rays.size());
    coherent ? together(first, end - first) : alone(first, end - first);
  }
}

void EmbreeTracer::set_ids(Hit& hit, unsigned inst, const EmbreeScene::Level& level, std::uint32_t object,
                           std::uint32_t primitive) const {
  hit.object = object, hit.primitive = primitive;
  if (inst == RTC_INVALID_GEOMETRY_ID) return;
  const Instance& instance = scene_.instances()[inst];
  hit.object = instance.object;
  hit.primitive += instance.first_primitive + level.geometry->objects[object].first_primitive;
}

void EmbreeTracer::triangle_hit(const Answer& answer, const EmbreeScene::Level& level, double t, Hit& hit) const {
  const Geometry& g = *level.geometry;
  const std::uint32_t object = EmbreeScene::object_of(level, answer.prim);
  hit.t = t;
  hit.error = 0;
  hit.u = answer.u, hit.v = answer.v;
  hit.normal = answer.normal;
  hit.status = status_hit;
  set_ids(hit, answer.inst, level, object, answer.prim - g.objects[object].first);
  if (answer.inst == RTC_INVALID_GEOMETRY_ID) return;
  const glm::dvec3 turned = scene_.instances()[answer.inst].to_group.normal_to_world(glm::dvec3(answer.normal));
  hit.normal = glm::vec3(glm::normalize(turned));
}

void EmbreeTracer::quadric_hit(const Ray& ray, const Answer& answer, const EmbreeScene::Level& level, double t,
                               Hit& hit) const {
  const Geometry& g = *level.geometry;
  const QuadricBucket& bucket = *level.buckets[answer.geom - level.first_bucket];
  const Quadric& quadric = g.quadrics[bucket.quadrics[answer.prim]];
  const auto part = static_cast<std::uint32_t>(answer.u);
  const Instance* instance = answer.inst == RTC_INVALID_GEOMETRY_ID ? nullptr : &scene_.instances()[answer.inst];
  hit.t = t;
  hit.error = 0;
  hit.u = hit.v = 0;
  hit.normal = glm::vec3(quadric_normal(g, quadric, instance, part, ray.at(t)));
  hit.status = status_hit;
  set_ids(hit, answer.inst, level, quadric.object, part);
}

void EmbreeTracer::hit_of(const Ray& ray, const Answer& a, const QuadricContext& context, int lane, Hit& hit) const {
  const EmbreeScene::Level& level = scene_.level(a.inst);
  const double t = context.shift[lane] + static_cast<double>(a.t) * context.scale[lane];
  if (a.geom == level.triangles_id) return triangle_hit(a, level, t, hit);
  quadric_hit(ray, a, level, precision_ == Precision::fast ? t : context.nearest[lane], hit);
}

template <class RayHits, int lanes>
void EmbreeTracer::closest_packets(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) const {
  Packet<RayHits> packet;
  float* const soa = reinterpret_cast<float*>(&packet.rays);
  loader_.begin(lanes, is_coherent(ray_class), packet);
  for (std::size_t first = 0; first < rays.size(); first += lanes) {
    const auto now = rays.subspan(first, std::min<std::size_t>(lanes, rays.size() - first));
    forget_hits(soa, lanes);
    if (loader_.load(now, lanes, packet)) {
      if constexpr (lanes == 16) rtcIntersect16(packet.valid, scene_.scene(), &packet.context.embree, &packet.rays);
      if constexpr (lanes == 8) rtcIntersect8(packet.valid, scene_.scene(), &packet.context.embree, &packet.rays);
      if constexpr (lanes == 1) rtcIntersect1(scene_.scene(), &packet.context.embree, &packet.rays);
      if (any_hit(soa, lanes)) normalise(soa, lanes);
    }
    for (int i = 0; i < static_cast<int>(now.size()); ++i) {
      const Answer a = answer(soa, lanes, i);
      Hit& out = hits[first + static_cast<std::size_t>(i)];
      if (a.geom == RTC_INVALID_GEOMETRY_ID)
        out = Hit{.status = packet.status[i]};
      else
        hit_of(now[static_cast<std::size_t>(i)], a, packet.context, i, out);
    }
  }
}

template <class Rays, int lanes>
void EmbreeTracer::any_packets(std::span<const Ray> rays, std::span<std::uint32_t> status) const {
  Packet<Rays> packet;
  loader_.begin(lanes, lanes > 1, packet);
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
  check_lengths(rays.size(), hits.size());
  for_ranges(rays.size(), [&](std::size_t first, std::size_t last) {
    const auto some = rays.subspan(first, last - first);
    const auto out = hits.subspan(first, last - first);
    const bool wide = scene_.native_packet() == 16;
    const auto together = [&](std::size_t from, std::size_t count) {
      if (wide) return closest_packets<RTCRayHit16, 16>(some.subspan(from, count), out.subspan(from, count), ray_class);
      closest_packets<RTCRayHit8, 8>(some.subspan(from, count), out.subspan(from, count), ray_class);
    };
    const auto alone = [&](std::size_t from, std::size_t count) {
      closest_packets<RTCRayHit, 1>(some.subspan(from, count), out.subspan(from, count), ray_class);
    };
    if (is_coherent(ray_class)) return together(0, some.size());
    for_runs(some, wide ? 16 : 8, together, alone);
  });
}

void EmbreeTracer::any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) {
  check_lengths(rays.size(), status.size());
  for_ranges(rays.size(), [&](std::size_t first, std::size_t last) {
    const auto some = rays.subspan(first, last - first);
    const auto out = status.subspan(first, last - first);
    const bool wide = scene_.native_packet() == 16;
    const auto together = [&](std::size_t from, std::size_t count) {
      if (wide) return any_packets<RTCRay16, 16>(some.subspan(from, count), out.subspan(from, count));
      any_packets<RTCRay8, 8>(some.subspan(from, count), out.subspan(from, count));
    };
    const auto alone = [&](std::size_t from, std::size_t count) {
      any_packets<RTCRay, 1>(some.subspan(from, count), out.subspan(from, count));
    };
    if (is_coherent(ray_class) || mostly_triangles_) return together(0, some.size());
    for_runs(some, wide ? 16 : 8, together, alone);
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
  loader_.begin(1, false, packet);
  HitCollector collector;
  packet.context.collector = &collector;
  packet.context.embree.filter = collect_triangle;
  packet.rays.hit.geomID = packet.rays.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  if (loader_.load({&ray, 1}, 1, packet)) rtcIntersect1(filtering_->scene(), &packet.context.embree, &packet.rays);
  std::vector<Hit> hits;
  for (const auto& e : collector.entries) {
    const EmbreeScene::Level& level = scene_.level(e.inst);
    Hit& hit = hits.emplace_back();
    if (e.geom != level.triangles_id) {
      quadric_hit(ray, {0, e.u, e.v, {}, e.geom, e.prim, e.inst}, level, e.t, hit);
      continue;
    }
    const glm::vec3 normal(glm::normalize(triangle_normal(*level.geometry, e.prim)));
    triangle_hit({0, e.u, e.v, normal, e.geom, e.prim, e.inst}, level, e.t, hit);
  }
  sort_hits(hits);
  return hits;
}

HitLists EmbreeTracer::all(std::span<const Ray> rays) {
  std::call_once(filtering_once_, [&] { filtering_ = std::make_unique<EmbreeScene>(geometry_, precision_, true); });
  return all_lists(rays.size(), [&](std::size_t i) { return all(rays[i]); });
}

}  // namespace

std::unique_ptr<Tracer> make_embree_tracer(std::shared_ptr<const Geometry> geometry, Precision precision) {
  if (precision != Precision::fast && precision != Precision::robust)
    throw Error("the embree tracer holds the precisions fast and robust, not " + std::string(to_string(precision)));
  return std::make_unique<EmbreeTracer>(std::move(geometry), precision);
}

}  // namespace rayengine
