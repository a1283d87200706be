#include "cpu/reference_tracer.h"

#include <tbb/parallel_for.h>

#include "accel/stopwatch.h"
#include "cpu/reference/sinks.h"
#include "cpu/reference/walk.h"

namespace rayengine {
namespace {

class ReferenceTracer final : public Tracer {
 public:
  explicit ReferenceTracer(std::shared_ptr<const Geometry> geometry, const Stopwatch& watch = {})
      : geometry_(std::move(geometry)), walk_(*geometry_), seconds_(watch.seconds()) {}

  std::string_view name() const override { return "reference"; }
  Precision precision() const override { return Precision::certified; }
  Limits limits() const override { return {}; }
  double build_seconds() const override { return seconds_; }
  std::size_t bytes() const override { return walk_.bytes(); }

  void closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass) override {
    check_lengths(rays.size(), hits.size());
    each(rays, [&](std::size_t i) { hits[i] = closest(rays[i]); });
  }

  void any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass) override {
    check_lengths(rays.size(), status.size());
    each(rays, [&](std::size_t i) { status[i] = any(rays[i]); });
  }

  HitLists all(std::span<const Ray> rays) override {
    std::vector<std::vector<Hit>> found(rays.size());
    each(rays, [&](std::size_t i) { found[i] = all(rays[i]); });
    HitLists lists;
    lists.offsets.push_back(0);
    for (const std::vector<Hit>& hits : found) {
      lists.hits.insert(lists.hits.end(), hits.begin(), hits.end());
      lists.offsets.push_back(lists.hits.size());
    }
    return lists;
  }

 private:
  template <class Work>
  static void each(std::span<const Ray> rays, const Work& work) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rays.size(), 16), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i) work(i);
    });
  }

  Hit closest(const Ray& ray) const {
    if (!is_valid(ray)) return {.status = status_invalid};
    reference::Closest sink(ray);
    walk_.trace(ray, sink);
    return sink.hit();
  }

  std::uint32_t any(const Ray& ray) const {
    if (!is_valid(ray)) return status_invalid;
    reference::Any sink(ray);
    walk_.trace(ray, sink);
    return sink.status();
  }

  std::vector<Hit> all(const Ray& ray) const {
    if (!is_valid(ray)) return {};
    reference::All sink(ray, closed_);
    walk_.trace(ray, sink);
    return sink.hits();
  }

  std::shared_ptr<const Geometry> geometry_;
  reference::Walk walk_;
  reference::ClosedMeshes closed_{*geometry_};
  double seconds_;
};

}  // namespace

std::unique_ptr<Tracer> make_reference_tracer(std::shared_ptr<const Geometry> geometry) {
  return std::make_unique<ReferenceTracer>(std::move(geometry));
}

}  // namespace rayengine
