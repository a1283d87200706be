#include "cpu/reference_tracer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <optional>

#include "accel/stopwatch.h"
#include "cpu/reference/walk.h"

namespace rayengine {
namespace {

using reference::Candidate;

class Closest final : public reference::Sink {
 public:
  explicit Closest(const Ray& ray) : ray_(ray) {}

  void add(const Candidate& candidate) override {
    const int order = best_ ? reference::compare_t(ray_, candidate, *best_) : -1;
    if (order <= 0) tied_ = order == 0;
    if (!best_ || reference::before(ray_, candidate, *best_)) best_ = candidate;
  }
  double reach() const override { return best_ ? std::min(static_cast<double>(best_->at.t), ray_.tmax) : ray_.tmax; }

  Hit hit() const {
    if (!best_) return {};
    Hit hit = reference::describe(ray_, *best_);
    if (tied_) hit.status |= status_tie;
    return hit;
  }

 private:
  const Ray& ray_;
  std::optional<Candidate> best_;
  bool tied_ = false;
};

class Any final : public reference::Sink {
 public:
  explicit Any(const Ray& ray) : tmax_(ray.tmax) {}

  void add(const Candidate&) override { found_ = true; }
  double reach() const override { return found_ ? -infinity : tmax_; }
  std::uint32_t status() const { return found_ ? status_hit : status_miss; }

 private:
  double tmax_;
  bool found_ = false;
};

class All final : public reference::Sink {
 public:
  explicit All(const Ray& ray) : ray_(ray) {}

  void add(const Candidate& candidate) override {
    const auto earlier = [&](const Candidate& a, const Candidate& b) { return reference::before(ray_, a, b); };
    found_.insert(std::upper_bound(found_.begin(), found_.end(), candidate, earlier), candidate);
  }
  double reach() const override { return ray_.tmax; }

  std::vector<Hit> hits() const {
    std::vector<Hit> result;
    for (const Candidate& c : found_) result.push_back(reference::describe(ray_, c));
    for (std::size_t i = 1; i < found_.size(); ++i)
      if (reference::compare_t(ray_, found_[i - 1], found_[i]) == 0)
        result[i - 1].status |= status_tie, result[i].status |= status_tie;
    return result;
  }

 private:
  const Ray& ray_;
  std::vector<Candidate> found_;
};

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
    Closest sink(ray);
    walk_.trace(ray, sink);
    return sink.hit();
  }

  std::uint32_t any(const Ray& ray) const {
    if (!is_valid(ray)) return status_invalid;
    Any sink(ray);
    walk_.trace(ray, sink);
    return sink.status();
  }

  std::vector<Hit> all(const Ray& ray) const {
    if (!is_valid(ray)) return {};
    All sink(ray);
    walk_.trace(ray, sink);
    return sink.hits();
  }

  std::shared_ptr<const Geometry> geometry_;
  reference::Walk walk_;
  double seconds_;
};

}  // namespace

std::unique_ptr<Tracer> make_reference_tracer(std::shared_ptr<const Geometry> geometry) {
  return std::make_unique<ReferenceTracer>(std::move(geometry));
}

}  // namespace rayengine
