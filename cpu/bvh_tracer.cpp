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
  void add_instances(const Ray& ray, Hit& hit) const;
  bool any_instance(const Ray& ray) const;
  std::vector<Hit> all(const Ray& ray) const;

  BvhScene scene_;
  std::string_view name_;
  BvhInstances instances_;
  double build_seconds_;
};

bool comes_first(const Hit& a, const Hit& b) {
  return std::tie(a.t, a.object, a.primitive) < std::tie(b.t, b.object, b.primitive);
}

/// Brings in what is met of instances.
void BvhTracer::add_instances(const Ray& ray, Hit& hit) const {
  instances_.for_met(ray, [&](const Instance& instance, const BvhScene& group, Ray local) {
    local.tmax = std::min(local.tmax, hit.t);
    if (!is_valid(local)) return hit.t;
    BvhFound inside{&group.geometry(), &instance};
    bvh_queries().closest(group.job(), &local, 1, &inside.answer);
    if (inside.answer.part == BvhAnswer::miss) return hit.t;
    const Hit other = hit_of(ray, inside);
    if (comes_first(other, hit)) hit = other;
    return hit.t;
  });
}

bool BvhTracer::any_instance(const Ray& ray) const {
  bool any = false;
  instances_.for_met(ray, [&](const Instance&, const BvhScene& group, const Ray& local) {
    std::uint32_t status = status_miss;
    if (!any && is_valid(local)) bvh_queries().any(group.job(), &local, 1, &status);
    any |= status == status_hit;
    return any ? -infinity : ray.tmax;
  });
  return any;
}

void BvhTracer::closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass) {
  check_lengths(rays.size(), hits.size());
  for_ranges(rays.size(), [&](std::size_t begin, std::size_t end) {
    const auto mine = rays.subspan(begin, end - begin);
    BvhAnswer answers[longest_run];
    const auto trace = [&](std::size_t first, std::size_t last) {
      bvh_queries().closest(scene_.job(), &mine[first], last - first, answers);
      store_hits(scene_.geometry(), &mine[first], std::span(answers, last - first), &hits[begin + first]);
      if (instances_.empty()) return;
      for (std::size_t i = begin + first; i < begin + last; ++i) add_instances(rays[i], hits[i]);
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
      if (instances_.empty()) return;
      for (std::size_t i = first; i < last; ++i)
        if (answers[i] == status_miss && any_instance(mine[i])) answers[i] = status_hit;
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
  if (is_valid(ray))
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
