#include "cpu/bvh_tracer.h"

#include <tuple>

#include "accel/stopwatch.h"
#include "cpu/bvh_certified.h"
#include "cpu/bvh_hit.h"
#include "cpu/bvh_instances.h"
#include "cpu/ranges.h"

namespace rayengine {
namespace {

class BvhTracer final : public Tracer {
 public:
  BvhTracer(std::shared_ptr<const Geometry> geometry, Structure structure, const Stopwatch& watch = {})
      : scene_(geometry, Planeless::left_out, structure),
        name_(structure == Structure::bvh ? "bvh" : "loop"),
        instances_(*geometry, Planeless::left_out),
        build_seconds_(watch.seconds()) {}

  std::string_view name() const override { return name_; }
  Precision precision() const override { return Precision::robust; }
  double build_seconds() const override { return build_seconds_; }
  std::size_t bytes() const override { return scene_.bytes() + instances_.bytes(); }
  Limits limits() const override { return {.triangle_roundoff = 0x1p-53, .quadric_roundoff = 0x1p-53}; }

  void closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) override;
  void any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) override;
  HitLists all(std::span<const Ray> rays) override;

 private:
  void add_instances(std::span<const Ray> rays, std::span<Hit> hits) const;
  void add_instances(std::span<const Ray> rays, std::span<std::uint32_t> status) const;
  std::vector<Hit> all(const Ray& ray) const;

  BvhScene scene_;
  std::string_view name_;
  BvhInstances instances_;
  double build_seconds_;
};

bool comes_first(const Hit& a, const Hit& b) {
  return std::tie(a.t, a.object, a.primitive) < std::tie(b.t, b.object, b.primitive);
}

bool may_trace(const BvhScene&, const Ray& ray) { return is_valid(ray); }

/// The nearest hits of at most InstanceWalk::most_rays rays, as instances bring them in.
class NearestOfInstances {
 public:
  NearestOfInstances(std::span<const Ray> rays, std::span<Hit> hits) : rays_(rays), hits_(hits) {
    for (std::size_t i = 0; i < rays.size(); ++i) ends_[i] = std::min(rays[i].tmax, hits[i].t);
  }

  std::span<const double> ends() const { return std::span(ends_).first(rays_.size()); }

  void meet(const Meeting& meeting) {
    placed_.place(meeting, rays_, ends_, may_trace);
    bvh_queries().closest(meeting.group.job(), placed_.rays.data(), placed_.count, answers_.data());
    for (std::size_t k = 0; k < placed_.count; ++k)
      if (answers_[k].part != BvhAnswer::miss)
        take(placed_.number[k], {&meeting.group.geometry(), &meeting.instance, answers_[k]});
  }

  /// Makes hits of what was found.
  void store() {
    for (std::size_t i = 0; i < rays_.size(); ++i) store(i);
  }

 private:
  void store(std::size_t i) {
    if (found_[i].geometry) hits_[i] = hit_of(rays_[i], found_[i]);
    found_[i].geometry = nullptr;
  }

  void take(std::size_t i, const BvhFound& found) {
    if (found.answer.t == ends_[i]) {  // rare: ids decide
      store(i);
      if (!comes_first(hit_of(rays_[i], found), hits_[i])) return;
    }
    found_[i] = found;
    ends_[i] = found.answer.t;
  }

  std::span<const Ray> rays_;
  std::span<Hit> hits_;
  PlacedRays placed_;
  PlacedRays::EachRay<BvhAnswer> answers_;
  PlacedRays::EachRay<double> ends_;
  PlacedRays::EachRay<BvhFound> found_;
};

/// Brings in what is met of instances.
void BvhTracer::add_instances(std::span<const Ray> rays, std::span<Hit> hits) const {
  for_blocks(rays.size(), [&](std::size_t first, std::size_t count) {
    const auto mine = rays.subspan(first, count);
    NearestOfInstances nearest(mine, hits.subspan(first, count));
    instances_.for_met(mine, nearest.ends(), [&](const Meeting& meeting) { nearest.meet(meeting); });
    nearest.store();
  });
}

void BvhTracer::add_instances(std::span<const Ray> rays, std::span<std::uint32_t> status) const {
  std::uint32_t met[InstanceWalk::most_rays];
  PlacedRays placed;
  instances_.for_missed(rays, status, [&](const Meeting& meeting, auto mine, auto ends, auto answers) {
    placed.place(meeting, mine, ends, may_trace);
    bvh_queries().any(meeting.group.job(), placed.rays.data(), placed.count, met);
    for (std::size_t k = 0; k < placed.count; ++k)
      if (met[k] == status_hit) answers[placed.number[k]] = status_hit, ends[placed.number[k]] = -infinity;
  });
}

void BvhTracer::closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass) {
  check_lengths(rays.size(), hits.size());
  for_ranges(rays.size(), [&](std::size_t begin, std::size_t end) {
    const auto mine = rays.subspan(begin, end - begin);
    BvhAnswer answers[longest_run];
    const auto trace = [&](std::size_t first, std::size_t last) {
      bvh_queries().closest(scene_.job(), &mine[first], last - first, answers);
      store_hits(scene_.geometry(), &mine[first], std::span(answers, last - first), &hits[begin + first]);
      if (!instances_.empty())
        add_instances(mine.subspan(first, last - first), hits.subspan(begin + first, last - first));
    };
    for_runs(mine, is_valid, trace, [&](std::size_t i) { hits[begin + i] = {.status = status_invalid}; });
  });
}

void BvhTracer::any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass) {
  check_lengths(rays.size(), status.size());
  for_ranges(rays.size(), [&](std::size_t begin, std::size_t end) {
    const auto mine = rays.subspan(begin, end - begin);
    const auto answers = status.subspan(begin, end - begin);
    const auto trace = [&](std::size_t first, std::size_t last) {
      bvh_queries().any(scene_.job(), &mine[first], last - first, &answers[first]);
      if (!instances_.empty()) add_instances(mine.subspan(first, last - first), answers.subspan(first, last - first));
    };
    for_runs(mine, is_valid, trace, [&](std::size_t i) { answers[i] = status_invalid; });
  });
}

std::vector<Hit> BvhTracer::all(const Ray& ray) const {
  std::vector<Hit> hits;
  const auto add = [&](const BvhScene& scene, const Instance* instance, const Ray& local) {
    std::vector<BvhAnswer> answers;
    if (is_valid(local)) bvh_queries().all(scene.job(), local, append, &answers);
    for (const BvhAnswer& answer : answers) hits.push_back(hit_of(ray, {&scene.geometry(), instance, answer}));
    return ray.tmax;
  };
  add(scene_, nullptr, ray);
  if (!instances_.empty() && is_valid(ray))
    instances_.for_met(ray, [&](const Instance& instance, const BvhScene& group, const Ray& local) {
      return add(group, &instance, local);
    });
  sort_hits(hits);
  return hits;
}

HitLists BvhTracer::all(std::span<const Ray> rays) {
  return all_lists(rays.size(), [&](std::size_t i) { return all(rays[i]); });
}

}  // namespace

std::unique_ptr<Tracer> make_bvh_tracer(std::shared_ptr<const Geometry> geometry, Precision precision) {
  if (precision == Precision::certified) return make_certified_bvh(std::move(geometry));
  if (precision != Precision::robust)
    throw Error("the bvh tracer holds the precisions robust and certified, not " + std::string(to_string(precision)));
  return std::make_unique<BvhTracer>(std::move(geometry), Structure::bvh);
}

std::unique_ptr<Tracer> make_loop_tracer(std::shared_ptr<const Geometry> geometry) {
  return std::make_unique<BvhTracer>(std::move(geometry), Structure::none);
}

}  // namespace rayengine
