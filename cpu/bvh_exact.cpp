#include "cpu/bvh_exact.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

  double take(const BvhLeaf& leaf) {
    const Geometry& geometry = scene.geometry();
    for (std::uint32_t i = 0; i < leaf.triangle_count; ++i)
      reference::try_triangle(placed, geometry, scene.triangle(leaf, i), sink);
    for (std::uint32_t i = 0; i < leaf.quadric_count; ++i)
      reference::try_quadric(placed, geometry, scene.job().quadrics[leaf.first_quadric + i], sink);
    return reach(sink);
  }

  /// Everything in every leaf that the ray may meet.
  void try_leaves() {
    Ray rest = ray;
    if (scene.job().unbounded) rest.tmax = take(*scene.job().unbounded);
    const auto take_leaf = [](void* to, const BvhLeaf& leaf) { return static_cast<Trial*>(to)->take(leaf); };
    if (is_valid(rest)) bvh_queries().leaves(scene.job(), rest, take_leaf, this);
  }

  /// What bounds in double cannot rule out.
  void try_possible(std::vector<BvhFound>& possible) {
    std::vector<BvhAnswer> answers;
    bvh_queries().certain_all(scene.job(), ray, error, append, &answers);
    std::vector<std::pair<bool, std::uint32_t>> primitives;  // whether it is a triangle, and which
    for (const BvhAnswer& a : answers) {
      possible.push_back({&scene.geometry(), placed.instance, a});
      primitives.emplace_back(a.part == BvhAnswer::triangle, a.index);
    }
    std::sort(primitives.begin(), primitives.end());
    primitives.erase(std::unique(primitives.begin(), primitives.end()), primitives.end());
    for (const auto& [is_triangle, index] : primitives)
      is_triangle ? reference::try_triangle(placed, scene.geometry(), index, sink)
                  : reference::try_quadric(placed, scene.geometry(), index, sink);
  }

  void run(std::vector<BvhFound>& possible) {
    scene.moderate() && is_moderate(ray) ? try_possible(possible) : try_leaves();
  }
};

}  // namespace

RayError placing_error(const Ray& ray, const WorldToObject& map) {
  const double six_roundings = 6 * 0x1p-53 * norm_of(map.linear);
  return {six_roundings * largest_component(ray.origin - map.origin), six_roundings * largest_component(ray.direction)};
}

std::vector<BvhFound> trace_exactly(const BvhScene& scene, const BvhInstances& instances, Ray ray, double end,
                                    reference::Sink& sink) {
  std::vector<BvhFound> possible;
  const reference::LocalRay world(ray);
  Ray shorter = ray;
  shorter.tmax = std::min(ray.tmax, end);
  Trial{scene, {ray, world, nullptr}, shorter, {}, sink}.run(possible);
  if (instances.empty()) return possible;
  instances.for_met(shorter, [&](const Instance& instance, const BvhScene& group, Ray local) {
    const reference::LocalRay placed(world, instance.to_group);
    local.tmax = std::min(shorter.tmax, reach(sink));
    Trial{group, {ray, placed, &instance}, local, placing_error(ray, instance.to_group), sink}.run(possible);
    return reach(sink);
  });
  return possible;
}

}  // namespace rayengine
