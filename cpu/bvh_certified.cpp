#include "cpu/bvh_certified.h"

#include <atomic>
#include <cmath>

#include "accel/stopwatch.h"
#include "cpu/bvh_exact.h"
#include "cpu/bvh_hit.h"
#include "cpu/moderate.h"
#include "cpu/ranges.h"
#include "cpu/reference/sinks.h"

namespace rayengine {
namespace {

/// The nearest hit so far: its exact t lies between `low` and `high`, and no other's does.
struct Nearest {
  BvhFound found{};
  double low = infinity, high = infinity;

  void set(const BvhFound& to) {
    found = to;
    low = to.answer.t - to.answer.error;
    high = to.answer.t + to.answer.error;
  }
};

class CertifiedBvh final : public Tracer {
 public:
  explicit CertifiedBvh(std::shared_ptr<const Geometry> geometry, const Stopwatch& watch = {})
      : scene_(geometry, Planeless::kept), instances_(*geometry, Planeless::kept), build_seconds_(watch.seconds()) {}

  std::string_view name() const override { return "bvh"; }
  Precision precision() const override { return Precision::certified; }
  double build_seconds() const override { return build_seconds_; }
  std::size_t bytes() const override { return scene_.bytes() + instances_.bytes(); }
  std::uint64_t resolved_rays() const override { return resolved_; }
  /// What starts within the bounds of its own surface cannot be told in double; on slender triangles those are wide.
  Limits limits() const override { return {.clearance_roundoff = 0x1p-38}; }

  void closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) override;
  void any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) override;
  HitLists all(std::span<const Ray> rays) override;

 private:
  bool may_certify(const Ray& ray) const { return scene_.moderate() && is_valid(ray) && is_moderate(ray); }

  Hit nearest(const Ray& ray, const BvhAnswer& answer) const;
  bool nearest_instance(const Ray& ray, Nearest& nearest) const;
  std::uint32_t any_instance(const Ray& ray) const;
  bool collect(const Ray& ray, std::vector<Hit>& hits) const;
  std::vector<Hit> all(const Ray& ray) const;

  Hit exact_closest(const Ray& ray, double end = infinity) const;
  std::uint32_t exact_any(const Ray& ray) const;
  std::vector<Hit> exact_all(const Ray& ray) const;

  BvhScene scene_;
  BvhInstances instances_;
  reference::ClosedMeshes closed_{scene_.geometry()};
  double build_seconds_;
  mutable std::atomic<std::uint64_t> resolved_ = 0;
};

/// Whether that is what was found for sure, but for its place among others.
bool is(const BvhFound& found, const reference::Candidate& exact) {
  const BvhAnswer& a = found.answer;
  const std::uint32_t part = exact.is_triangle ? BvhAnswer::triangle : exact.at.primitive;
  return !a.unsure && found.instance == exact.instance && a.index == exact.index && a.part == part &&
         std::abs(a.t - static_cast<double>(exact.at.t)) <= a.error;
}

/// Of a hit that is sure in itself t is as if no other had come near: so answers do not depend on what was looked at.
Hit CertifiedBvh::exact_closest(const Ray& ray, double end) const {
  if (!is_valid(ray)) return {.status = status_invalid};
  ++resolved_;
  reference::Closest sink(ray);
  const std::vector<BvhFound> possible = trace_exactly(scene_, instances_, ray, end, sink);
  Hit hit = sink.hit();
  if (!hit.hit()) return hit;
  const std::uint32_t tie = hit.status & status_tie;
  const auto found =
      std::find_if(possible.begin(), possible.end(), [&](const BvhFound& f) { return is(f, *sink.best()); });
  if (found != possible.end())
    hit = hit_of(ray, *found);
  else
    hit.status |= status_resolved;
  hit.status |= tie;
  return hit;
}

std::uint32_t CertifiedBvh::exact_any(const Ray& ray) const {
  if (!is_valid(ray)) return status_invalid;
  ++resolved_;
  reference::Any sink(ray);
  trace_exactly(scene_, instances_, ray, infinity, sink);
  return sink.status();
}

std::vector<Hit> CertifiedBvh::exact_all(const Ray& ray) const {
  if (!is_valid(ray)) return {};
  ++resolved_;
  reference::All sink(ray, closed_);
  trace_exactly(scene_, instances_, ray, infinity, sink);
  std::vector<Hit> hits = sink.hits();
  for (Hit& hit : hits) hit.status |= status_resolved;
  return hits;
}

/// Whether it could be told.
bool CertifiedBvh::nearest_instance(const Ray& ray, Nearest& nearest) const {
  bool sure = true;
  instances_.for_met(ray, [&](const Instance& instance, const BvhScene& group, Ray local) {
    local.tmax = std::min(ray.tmax, nearest.high);
    sure = sure && group.moderate() && is_moderate(local);
    if (!sure) return -infinity;
    BvhFound inside{&group.geometry(), &instance};
    const RayError error = placing_error(ray, instance.to_group);
    bvh_queries().certain_closest(group.job(), &local, 1, error, &inside.answer);
    if (inside.answer.part == BvhAnswer::miss && !inside.answer.unsure) return local.tmax;
    sure = !inside.answer.unsure && inside.answer.t + inside.answer.error < nearest.low;
    if (sure) nearest.set(inside);
    return sure ? nearest.high : -infinity;
  });
  return sure;
}

Hit CertifiedBvh::nearest(const Ray& ray, const BvhAnswer& answer) const {
  Nearest nearest;
  if (answer.part != BvhAnswer::miss) nearest.set({&scene_.geometry(), nullptr, answer});
  if (answer.unsure || (!instances_.empty() && !nearest_instance(ray, nearest)))
    return exact_closest(ray, nearest.high);
  return nearest.found.geometry ? hit_of(ray, nearest.found) : Hit{};
}

void CertifiedBvh::closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass) {
  check_lengths(rays.size(), hits.size());
  for_ranges(rays.size(), [&](std::size_t begin, std::size_t end) {
    const auto mine = rays.subspan(begin, end - begin);
    BvhAnswer answers[longest_run];
    const auto trace = [&](std::size_t first, std::size_t last) {
      bvh_queries().certain_closest(scene_.job(), &mine[first], last - first, {}, answers);
      store_hits(scene_.geometry(), &mine[first], std::span(answers, last - first), &hits[begin + first]);
      for (std::size_t i = first; i < last; ++i)
        if (answers[i - first].unsure || !instances_.empty()) hits[begin + i] = nearest(mine[i], answers[i - first]);
    };
    for_runs(
        mine, [&](const Ray& ray) { return may_certify(ray); }, trace,
        [&](std::size_t i) { hits[begin + i] = exact_closest(mine[i]); });
  });
}

/// status_hit, status_miss, or status_unsure.
std::uint32_t CertifiedBvh::any_instance(const Ray& ray) const {
  std::uint32_t result = status_miss;
  instances_.for_met(ray, [&](const Instance& instance, const BvhScene& group, const Ray& local) {
    if (result == status_hit) return -infinity;
    std::uint32_t status = status_unsure;
    if (group.moderate() && is_moderate(local))
      bvh_queries().certain_any(group.job(), &local, 1, placing_error(ray, instance.to_group), &status);
    if (status != status_miss) result = status;
    return result == status_hit ? -infinity : ray.tmax;
  });
  return result;
}

void CertifiedBvh::any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass) {
  check_lengths(rays.size(), status.size());
  for_ranges(rays.size(), [&](std::size_t begin, std::size_t end) {
    const auto mine = rays.subspan(begin, end - begin);
    const auto answers = status.subspan(begin, end - begin);
    const auto trace = [&](std::size_t first, std::size_t last) {
      bvh_queries().certain_any(scene_.job(), &mine[first], last - first, {}, &answers[first]);
      for (std::size_t i = first; i < last; ++i) {
        if (answers[i] == status_miss && !instances_.empty()) answers[i] = any_instance(mine[i]);
        if (answers[i] == status_unsure) answers[i] = exact_any(mine[i]);
      }
    };
    for_runs(
        mine, [&](const Ray& ray) { return may_certify(ray); }, trace,
        [&](std::size_t i) { answers[i] = exact_any(mine[i]); });
  });
}

/// All hits in no order; whether they could be told.
bool CertifiedBvh::collect(const Ray& ray, std::vector<Hit>& hits) const {
  bool sure = true;
  const auto add = [&](const BvhScene& scene, const Instance* instance, const Ray& local, const RayError& error) {
    std::vector<BvhAnswer> answers;
    sure = sure && scene.moderate() && is_moderate(local);
    if (sure) bvh_queries().certain_all(scene.job(), local, error, append, &answers);
    for (const BvhAnswer& answer : answers) {
      sure = sure && !answer.unsure && answer.t - answer.error > ray.tmin && answer.t + answer.error <= ray.tmax;
      if (sure) hits.push_back(hit_of(ray, {&scene.geometry(), instance, answer}));
    }
    return sure ? ray.tmax : -infinity;
  };
  add(scene_, nullptr, ray, {});
  if (!instances_.empty())
    instances_.for_met(ray, [&](const Instance& instance, const BvhScene& group, const Ray& local) {
      return add(group, &instance, local, placing_error(ray, instance.to_group));
    });
  return sure;
}

std::vector<Hit> CertifiedBvh::all(const Ray& ray) const {
  std::vector<Hit> hits;
  if (!may_certify(ray) || !collect(ray, hits)) return exact_all(ray);
  sort_hits(hits);
  const auto overlap = [](const Hit& a, const Hit& b) { return !(a.t + a.error < b.t - b.error); };
  const bool unsure = std::adjacent_find(hits.begin(), hits.end(), overlap) != hits.end();
  return unsure ? exact_all(ray) : hits;
}

HitLists CertifiedBvh::all(std::span<const Ray> rays) {
  return all_lists(rays.size(), [&](std::size_t i) { return all(rays[i]); });
}

}  // namespace

std::unique_ptr<Tracer> make_certified_bvh(std::shared_ptr<const Geometry> geometry) {
  return std::make_unique<CertifiedBvh>(std::move(geometry));
}

}  // namespace rayengine
