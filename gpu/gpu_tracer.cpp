#include "gpu/gpu_tracer.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <tuple>

#include "accel/stopwatch.h"
#include "accel/surface.h"
#include "gpu/device/gl_thread.h"
#include "gpu/scene/flat_scene.h"

namespace rayengine {
namespace {

using Next = DeviceEngine::Next;

class GpuTracer : public Tracer {
 public:
  GpuTracer(std::string_view name, std::shared_ptr<const Geometry> geometry, Precision precision,
            const MakeEngine& make)
      : name_(name), geometry_(std::move(geometry)), precision_(precision) {
    const Stopwatch watch;
    thread_.run([&] { engine_ = make(); });
    build_seconds_ = watch.seconds();
  }
  ~GpuTracer() override {
    thread_.run([this] { engine_.reset(); });
  }

  std::string_view name() const override { return name_; }
  Precision precision() const override { return precision_; }
  Limits limits() const override {
    const double roundoff = precision_ == Precision::half ? 0x1p-11 : 0x1p-24;
    return {false, engine_->batch_rays(), roundoff, roundoff};
  }
  double build_seconds() const override { return build_seconds_; }
  std::size_t bytes() const override { return engine_->bytes(); }

  void closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass) override {
    check_lengths(rays.size(), hits.size());
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = miss(rays[i]);
    thread_.run([&] {
      engine_->trace(rays, StreamQuery::closest, [&](const Traveller& t) { return keep(t, rays[t.ray], hits[t.ray]); });
    });
  }

  void any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) override {
    check_lengths(rays.size(), status.size());
    for (std::size_t i = 0; i < rays.size(); ++i) status[i] = miss(rays[i]).status;
    std::mutex mutex;
    std::vector<std::uint32_t> doubtful;
    thread_.run([&] {
      engine_->trace(rays, StreamQuery::any, [&](const Traveller& t) {
        if (t.best_rank == no_id) return Next::done;
        status[t.ray] = status_hit;
        if (!found(t, rays[t.ray])) {
          const std::lock_guard lock(mutex);
          doubtful.push_back(t.ray);
        }
        return Next::done;
      });
    });
    settle(rays, status, doubtful, ray_class);
  }

  HitLists all(std::span<const Ray> rays) override {
    if (precision_ == Precision::half) throw Error("precision half holds no lists of all hits: choose fast or robust");
    std::mutex mutex;
    std::vector<std::pair<std::uint32_t, Hit>> found_hits;
    thread_.run([&] {
      engine_->trace(rays, StreamQuery::closest, [&](const Traveller& t) {
        if (t.best_rank == no_id) return Next::done;
        if (const auto hit = found(t, rays[t.ray])) {
          const std::lock_guard lock(mutex);
          found_hits.emplace_back(t.ray, *hit);
        }
        return Next::behind;
      });
    });
    return sorted(rays.size(), std::move(found_hits));
  }

 private:
  static Hit miss(const Ray& ray) {
    Hit hit;
    if (!is_valid(ray)) hit.status = status_invalid;
    return hit;
  }

  /// The traveller's best hit, worked out in double as far as the precision goes; nothing when that shows that the ray
  /// only runs along the surface, or meets it outside of its interval.
  std::optional<Hit> found(const Traveller& t, const Ray& ray) const {
    if (t.best_rank >= geometry_->primitive_count)
      throw Error("the GPU answered with primitive " + std::to_string(t.best_rank) + " of " +
                  std::to_string(geometry_->primitive_count) + "; use --tracer embree");
    const Ids ids = ids_of_rank(*geometry_, t.best_rank);
    Hit hit;
    hit.t = t.frame.to_world(t.best_t);
    hit.object = ids.object, hit.primitive = ids.primitive;
    hit.status = status_hit;
    if (precision_ == Precision::half) {
      hit.normal = t.normal;
      return hit;  // too coarse to be held to the interval
    }
    const Hit refined = refine(*geometry_, ray, hit);
    hit.u = refined.u, hit.v = refined.v, hit.normal = refined.normal;
    if (precision_ == Precision::robust) {
      if (!std::isfinite(refined.error)) return std::nullopt;
      hit.t = refined.t;  // its bound holds if this is the right root of the right primitive, which is not proven
    }
    if (!(hit.t > ray.tmin && hit.t <= ray.tmax)) return std::nullopt;
    return hit;
  }

  /// What single precision found may not count: then the ray goes on behind it.
  Next keep(const Traveller& t, const Ray& ray, Hit& hit) const {
    if (t.best_rank == no_id) return Next::done;
    if (const auto candidate = found(t, ray)) {
      hit = *candidate;
      return Next::done;
    }
    return Next::behind;
  }

  /// An any-hit query that found only what does not count may have passed over what does.
  void settle(std::span<const Ray> rays, std::span<std::uint32_t> status, const std::vector<std::uint32_t>& doubtful,
              RayClass ray_class) {
    std::vector<Ray> again;
    for (const std::uint32_t i : doubtful) again.push_back(rays[i]);
    std::vector<Hit> hits(again.size());
    if (!again.empty()) closest(again, hits, ray_class);
    for (std::size_t k = 0; k < hits.size(); ++k) status[doubtful[k]] = hits[k].status;
  }

  static HitLists sorted(std::size_t rays, std::vector<std::pair<std::uint32_t, Hit>> found_hits) {
    const auto key = [](const auto& f) { return std::tuple(f.first, f.second.t, f.second.object, f.second.primitive); };
    std::sort(found_hits.begin(), found_hits.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
    // Roots that single precision told apart may be one in double.
    found_hits.erase(
        std::unique(found_hits.begin(), found_hits.end(), [&](auto& a, auto& b) { return key(a) == key(b); }),
        found_hits.end());
    HitLists lists;
    lists.offsets.resize(rays + 1);
    for (const auto& [ray, hit] : found_hits) ++lists.offsets[ray + 1], lists.hits.push_back(hit);
    for (std::size_t i = 0; i < rays; ++i) lists.offsets[i + 1] += lists.offsets[i];
    return lists;
  }

  std::string_view name_;
  std::shared_ptr<const Geometry> geometry_;
  Precision precision_;
  double build_seconds_ = 0;
  GlThread thread_;
  std::unique_ptr<DeviceEngine> engine_;  // made and destroyed on that thread
};

}  // namespace

std::unique_ptr<Tracer> make_gpu_tracer(std::string_view name, std::shared_ptr<const Geometry> geometry,
                                        Precision precision, const MakeEngine& make) {
  return std::make_unique<GpuTracer>(name, std::move(geometry), precision, make);
}

}  // namespace rayengine
