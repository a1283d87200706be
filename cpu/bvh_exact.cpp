#include "cpu/bvh_exact.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "cpu/moderate.h"
#include "cpu/reference/trial.h"

namespace rayengine {
namespace {

/// A little further along the ray than what the sink still wants.
double reach(const reference::Sink& sink) {
  const double t = sink.reach();
  return std::isinf(t) ? t : t + 0x1p-40 * std::abs(t);
}

/// A scene, the ray as it sees it, exactly and in double, and how far off the latter is.
struct Trial {
  const BvhScene& scene;
  const reference::Placed& placed;
  Ray ray;
  RayError error;
  reference::Sink& sink;

  double take(const BvhLeaf& leaf) const {
    const Geometry& geometry = scene.geometry();
    for (std::uint32_t i = 0; i < leaf.triangle_count; ++i)
      reference::try_triangle(placed, geometry, scene.triangle(leaf, i), sink);
    for (std::uint32_t i = 0; i < leaf.quadric_count; ++i)
      reference::try_quadric(placed, geometry, scene.job().quadrics[leaf.first_quadric + i], sink);
    return reach(sink);
  }

  /// Everything in every leaf that the ray may meet.
  void try_leaves() const {
    Ray rest = ray;
    if (scene.job().unbounded) rest.tmax = take(*scene.job().unbounded);
    const auto take_leaf = [](void* to, const BvhLeaf& leaf) { return static_cast<const Trial*>(to)->take(leaf); };
    if (is_valid(rest)) bvh_queries().leaves(scene.job(), rest, take_leaf, const_cast<Trial*>(this));
  }

  /// What bounds in double cannot rule out.
  void try_possible() const {
    using Primitive = std::tuple<bool, std::uint32_t>;  // whether it is a triangle, and which
    std::vector<Primitive> possible;
    const auto collect = [](void* to, const BvhAnswer& a) {
      static_cast<std::vector<Primitive>*>(to)->emplace_back(a.part == BvhAnswer::triangle, a.index);
    };
    bvh_queries().certain_all(scene.job(), ray, error, collect, &possible);
    std::sort(possible.begin(), possible.end());
    possible.erase(std::unique(possible.begin(), possible.end()), possible.end());
    for (const auto& [is_triangle, index] : possible)
      is_triangle ? reference::try_triangle(placed, scene.geometry(), index, sink)
                  : reference::try_quadric(placed, scene.geometry(), index, sink);
  }

  void run() const { scene.moderate() && is_moderate(ray) ? try_possible() : try_leaves(); }
};

}  // namespace

RayError placing_error(const Ray& ray, const WorldToObject& map) {
  const double six_roundings = 6 * 0x1p-53 * norm_of(map.linear);
  return {six_roundings * largest_component(ray.origin - map.origin), six_roundings * largest_component(ray.direction)};
}

void trace_exactly(const BvhScene& scene, const BvhInstances& instances, Ray ray, double end, reference::Sink& sink) {
  const reference::LocalRay world(ray);
  Ray shorter = ray;
  shorter.tmax = std::min(ray.tmax, end);
  Trial{scene, {ray, world, nullptr}, shorter, {}, sink}.run();
  if (instances.empty()) return;
  instances.for_met(shorter, [&](const Instance& instance, const BvhScene& group, Ray local) {
    const reference::LocalRay placed(world, instance.to_group);
    local.tmax = std::min(shorter.tmax, reach(sink));
    Trial{group, {ray, placed, &instance}, local, placing_error(ray, instance.to_group), sink}.run();
    return reach(sink);
  });
}

}  // namespace rayengine
