#include "cpu/bvh_certified.h"

#include <algorithm>
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

bool may_certify(const BvhScene& scene, const Ray& ray) {
  return scene.moderate() && is_valid(ray) && is_moderate(ray);
}

/// Where what was found ends at most.
double end_of(const BvhAnswer& answer) { return answer.part == BvhAnswer::miss ? infinity : answer.t + answer.error; }

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
  void add_instances(std::span<const Ray> rays, std::span<const BvhAnswer> answers, std::span<Hit> hits) const;
  void add_instances(std::span<const Ray> rays, std::span<std::uint32_t> status) const;
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

/// A group's rays with their errors; of the others double precision cannot tell.
struct CertainRays : PlacedRays {
  void place_certain(const Meeting& meeting, std::span<const Ray> asked, std::span<const double> ends) {
    place(meeting, asked, ends, may_certify);
    for (std::size_t k = 0; k < count; ++k) errors[k] = placing_error(asked[number[k]], meeting.instance.to_group);
  }

  EachRay<RayError> errors;
};

/// The nearest hits of at most InstanceWalk::most_rays rays, while they can be told.
class CertainNearest {
 public:
  CertainNearest(const Geometry& geometry, std::span<const Ray> rays, std::span<const BvhAnswer> answers)
      : rays_(rays) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (answers[i].part != BvhAnswer::miss) nearest_[i].set({&geometry, nullptr, answers[i]});
      ends_[i] = answers[i].unsure ? -infinity : std::min(rays[i].tmax, nearest_[i].high);
      sure_[i] = !answers[i].unsure;
    }
  }

  std::span<const double> ends() const { return std::span(ends_).first(rays_.size()); }

  void meet(const Meeting& meeting) {
    placed_.place_certain(meeting, rays_, ends_);
    bvh_queries().certain_closest(meeting.group.job(), placed_.rays.data(), placed_.count, placed_.errors.data(),
                                  answers_.data());
    for (std::size_t k = 0; k < placed_.count; ++k)
      take(placed_.number[k], {&meeting.group.geometry(), &meeting.instance, answers_[k]});
    for (std::size_t k = 0; k < placed_.other_count; ++k) give_up(placed_.other[k]);
  }

  /// Null where it could not be told.
  const Nearest* operator[](std::size_t i) const { return sure_[i] ? &nearest_[i] : nullptr; }
  double end(std::size_t i) const { return nearest_[i].high; }

 private:
  void take(std::size_t i, const BvhFound& found) {
    const BvhAnswer& a = found.answer;
    if (a.part == BvhAnswer::miss && !a.unsure) return;
    if (a.unsure || !(a.t + a.error < nearest_[i].low)) return give_up(i);
    nearest_[i].set(found);
    ends_[i] = std::min(rays_[i].tmax, nearest_[i].high);
  }

  void give_up(std::size_t i) {
    sure_[i] = false;
    ends_[i] = -infinity;
  }

  std::span<const Ray> rays_;
  CertainRays placed_;
  PlacedRays::EachRay<BvhAnswer> answers_;
  PlacedRays::EachRay<Nearest> nearest_;
  PlacedRays::EachRay<double> ends_;
  PlacedRays::EachRay<bool> sure_;
};

/// Brings in what is met of instances.
void CertifiedBvh::add_instances(std::span<const Ray> rays, std::span<const BvhAnswer> answers,
                                 std::span<Hit> hits) const {
  for_blocks(rays.size(), [&](std::size_t first, std::size_t count) {
    const auto mine = rays.subspan(first, count);
    CertainNearest nearest(scene_.geometry(), mine, answers.subspan(first, count));
    instances_.for_met(mine, nearest.ends(), [&](const Meeting& meeting) { nearest.meet(meeting); });
    for (std::size_t i = 0; i < count; ++i) {
      Hit& hit = hits[first + i];
      if (!nearest[i])
        hit = exact_closest(mine[i], nearest.end(i));
      else if (nearest[i]->found.instance)
        hit = hit_of(mine[i], nearest[i]->found);
    }
  });
}

void CertifiedBvh::closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass) {
  check_lengths(rays.size(), hits.size());
  for_ranges(rays.size(), [&](std::size_t begin, std::size_t end) {
    const auto mine = rays.subspan(begin, end - begin);
    BvhAnswer answers[longest_run];
    const auto trace = [&](std::size_t first, std::size_t last) {
      bvh_queries().certain_closest(scene_.job(), &mine[first], last - first, nullptr, answers);
      store_hits(scene_.geometry(), &mine[first], std::span(answers, last - first), &hits[begin + first]);
      if (!instances_.empty())
        return add_instances(mine.subspan(first, last - first), answers, hits.subspan(begin + first, last - first));
      for (std::size_t i = first; i < last; ++i)
        if (answers[i - first].unsure) hits[begin + i] = exact_closest(mine[i], end_of(answers[i - first]));
    };
    for_runs(
        mine, [&](const Ray& ray) { return may_certify(scene_, ray); }, trace,
        [&](std::size_t i) { hits[begin + i] = exact_closest(mine[i]); });
  });
}

/// Those that missed become status_hit, or status_unsure where it cannot be told.
void CertifiedBvh::add_instances(std::span<const Ray> rays, std::span<std::uint32_t> status) const {
  std::uint32_t met[InstanceWalk::most_rays];
  CertainRays placed;
  instances_.for_missed(rays, status, [&](const Meeting& meeting, auto mine, auto ends, auto answers) {
    placed.place_certain(meeting, mine, ends);
    bvh_queries().certain_any(meeting.group.job(), placed.rays.data(), placed.count, placed.errors.data(), met);
    for (std::size_t k = 0; k < placed.count; ++k) {
      const std::uint32_t i = placed.number[k];
      if (met[k] != status_miss) answers[i] = met[k];
      if (met[k] == status_hit) ends[i] = -infinity;
    }
    for (std::size_t k = 0; k < placed.other_count; ++k) answers[placed.other[k]] = status_unsure;
  });
}

void CertifiedBvh::any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass) {
  check_lengths(rays.size(), status.size());
  for_ranges(rays.size(), [&](std::size_t begin, std::size_t end) {
    const auto mine = rays.subspan(begin, end - begin);
    const auto answers = status.subspan(begin, end - begin);
    const auto trace = [&](std::size_t first, std::size_t last) {
      bvh_queries().certain_any(scene_.job(), &mine[first], last - first, nullptr, &answers[first]);
      if (!instances_.empty()) add_instances(mine.subspan(first, last - first), answers.subspan(first, last - first));
      for (std::size_t i = first; i < last; ++i)
        if (answers[i] == status_unsure) answers[i] = exact_any(mine[i]);
    };
    for_runs(
        mine, [&](const Ray& ray) { return may_certify(scene_, ray); }, trace,
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
  if (!may_certify(scene_, ray) || !collect(ray, hits)) return exact_all(ray);
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
