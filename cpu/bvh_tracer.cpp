#include "cpu/bvh_tracer.h"

#include <glm/geometric.hpp>
#include <tuple>

#include "accel/stopwatch.h"
#include "accel/surface.h"
#include "cpu/bvh_instances.h"
#include "cpu/ranges.h"

namespace rayengine {
namespace {

const BvhQueries& queries() {
  switch (best_isa()) {
    case Isa::avx512: return avx512::bvh_queries;
    case Isa::avx2: return avx2::bvh_queries;
    case Isa::sse2: break;
  }
  return sse2::bvh_queries;
}

/// What was hit in a geometry or, through one of its instances, in a group.
struct Found {
  const Geometry* geometry;
  const Instance* instance;  ///< null when it is not instanced
  BvhAnswer answer;
};

class BvhTracer final : public Tracer {
 public:
  explicit BvhTracer(std::shared_ptr<const Geometry> geometry, const Stopwatch& watch = {})
      : scene_(geometry), instances_(*geometry), build_seconds_(watch.seconds()) {}

  std::string_view name() const override { return "bvh"; }
  Precision precision() const override { return Precision::robust; }
  double build_seconds() const override { return build_seconds_; }
  std::size_t bytes() const override { return scene_.bytes() + instances_.bytes(); }
  Limits limits() const override { return {.triangle_roundoff = 0x1p-53, .quadric_roundoff = 0x1p-53}; }

  void closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) override;
  void any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) override;
  HitLists all(std::span<const Ray> rays) override;

 private:
  void set_nearest(const Ray& ray, const BvhAnswer& answer, Hit& hit) const;
  bool any_instance(const Ray& ray) const;
  std::vector<Hit> all(const Ray& ray) const;

  BvhScene scene_;
  BvhInstances instances_;
  double build_seconds_;
};

/// Runs of valid rays to `valid(first, last)`, others one by one to `invalid(i)`.
template <class Valid, class Invalid>
void for_valid(std::span<const Ray> rays, Valid&& valid, Invalid&& invalid) {
  for (std::size_t first = 0, last; first < rays.size(); first = last) {
    for (last = first; last < rays.size() && is_valid(rays[last]);) ++last;
    if (last > first)
      valid(first, last);
    else
      invalid(last++);
  }
}

void set_triangle(const Found& found, Hit& hit) {
  const Geometry& g = *found.geometry;
  hit.object = g.triangle_object[found.answer.index];
  hit.primitive = found.answer.index - g.objects[hit.object].first;
  const glm::dvec3 normal = glm::normalize(triangle_normal(g, found.answer.index));
  hit.normal = glm::vec3(found.instance ? glm::normalize(found.instance->to_group.normal_to_world(normal)) : normal);
}

void set(const Ray& ray, const Found& found, Hit& hit) {
  const BvhAnswer& a = found.answer;
  hit.t = a.t, hit.error = 0;
  hit.u = a.u, hit.v = a.v;
  hit.status = status_hit;
  if (a.part == BvhAnswer::triangle) {
    set_triangle(found, hit);
  } else {
    const Quadric& quadric = found.geometry->quadrics[a.index];
    hit.object = quadric.object, hit.primitive = a.part;
    hit.normal = glm::vec3(quadric_normal(*found.geometry, quadric, found.instance, a.part, ray.at(a.t)));
  }
  if (!found.instance) return;
  hit.primitive += found.instance->first_primitive + found.geometry->objects[hit.object].first_primitive;
  hit.object = found.instance->object;
}

bool comes_first(const Hit& a, const Hit& b) {
  return std::tie(a.t, a.object, a.primitive) < std::tie(b.t, b.object, b.primitive);
}

void BvhTracer::set_nearest(const Ray& ray, const BvhAnswer& answer, Hit& hit) const {
  hit = {};
  if (answer.part != BvhAnswer::miss) set(ray, {&scene_.geometry(), nullptr, answer}, hit);
  if (instances_.empty()) return;
  instances_.for_met(ray, [&](const Instance& instance, const BvhScene& group, Ray local) {
    local.tmax = std::min(local.tmax, hit.t);
    BvhAnswer inside;
    if (is_valid(local)) queries().closest(group.job(), &local, 1, &inside);
    if (!is_valid(local) || inside.part == BvhAnswer::miss) return hit.t;
    Hit other;
    set(ray, {&group.geometry(), &instance, inside}, other);
    if (comes_first(other, hit)) hit = other;
    return hit.t;
  });
}

bool BvhTracer::any_instance(const Ray& ray) const {
  bool any = false;
  instances_.for_met(ray, [&](const Instance&, const BvhScene& group, const Ray& local) {
    std::uint32_t status = status_miss;
    if (!any && is_valid(local)) queries().any(group.job(), &local, 1, &status);
    any |= status == status_hit;
    return any ? -infinity : ray.tmax;
  });
  return any;
}

void BvhTracer::closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass) {
  check_lengths(rays.size(), hits.size());
  for_ranges(rays.size(), [&](std::size_t begin, std::size_t end) {
    const auto mine = rays.subspan(begin, end - begin);
    std::vector<BvhAnswer> answers(mine.size());
    const auto trace = [&](std::size_t first, std::size_t last) {
      queries().closest(scene_.job(), &mine[first], last - first, &answers[first]);
      for (std::size_t i = first; i < last; ++i) set_nearest(mine[i], answers[i], hits[begin + i]);
    };
    for_valid(mine, trace, [&](std::size_t i) { hits[begin + i] = {.status = status_invalid}; });
  });
}

void BvhTracer::any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass) {
  check_lengths(rays.size(), status.size());
  for_ranges(rays.size(), [&](std::size_t begin, std::size_t end) {
    const auto mine = rays.subspan(begin, end - begin);
    const auto answers = status.subspan(begin, end - begin);
    const auto trace = [&](std::size_t first, std::size_t last) {
      queries().any(scene_.job(), &mine[first], last - first, &answers[first]);
      if (instances_.empty()) return;
      for (std::size_t i = first; i < last; ++i)
        if (answers[i] == status_miss && any_instance(mine[i])) answers[i] = status_hit;
    };
    for_valid(mine, trace, [&](std::size_t i) { answers[i] = status_invalid; });
  });
}

std::vector<Hit> BvhTracer::all(const Ray& ray) const {
  std::vector<Hit> hits;
  const auto add = [&](const BvhScene& scene, const Instance* instance, const Ray& local) {
    std::vector<BvhAnswer> answers;
    const auto collect = [](void* to, const BvhAnswer& a) { static_cast<std::vector<BvhAnswer>*>(to)->push_back(a); };
    if (is_valid(local)) queries().all(scene.job(), local, collect, &answers);
    for (const BvhAnswer& answer : answers) set(ray, {&scene.geometry(), instance, answer}, hits.emplace_back());
    return ray.tmax;
  };
  add(scene_, nullptr, ray);
  if (is_valid(ray))
    instances_.for_met(ray, [&](const Instance& instance, const BvhScene& group, const Ray& local) {
      return add(group, &instance, local);
    });
  return hits;
}

HitLists BvhTracer::all(std::span<const Ray> rays) {
  return all_lists(rays.size(), [&](std::size_t i) { return all(rays[i]); });
}

}  // namespace

std::unique_ptr<Tracer> make_bvh_tracer(std::shared_ptr<const Geometry> geometry, Precision precision) {
  if (precision != Precision::robust)
    throw Error("the bvh tracer holds the precision robust, not " + std::string(to_string(precision)));
  return std::make_unique<BvhTracer>(std::move(geometry));
}

}  // namespace rayengine
