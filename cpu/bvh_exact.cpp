#include "cpu/bvh_exact.h"

#include <cmath>

#include "cpu/reference/trial.h"

namespace rayengine {
namespace {

/// A little further along the ray than what the sink still wants.
double reach(const reference::Sink& sink) {
  const double t = sink.reach();
  return std::isinf(t) ? t : t + 0x1p-40 * std::abs(t);
}

struct Visit {
  const BvhScene& scene;
  const reference::Placed& placed;
  reference::Sink& sink;

  double take(const BvhLeaf& leaf) const {
    const Geometry& geometry = scene.geometry();
    for (std::uint32_t i = 0; i < leaf.triangle_count; ++i)
      reference::try_triangle(placed, geometry, scene.triangle(leaf, i), sink);
    for (std::uint32_t i = 0; i < leaf.quadric_count; ++i)
      reference::try_quadric(placed, geometry, scene.job().quadrics[leaf.first_quadric + i], sink);
    return reach(sink);
  }
};

/// `approximate` is the placed ray in double: boxes are wider than what that rounds.
void visit(const BvhScene& scene, const reference::Placed& placed, Ray approximate, reference::Sink& sink) {
  Visit visitor{scene, placed, sink};
  approximate.tmax = reach(sink);
  if (scene.job().unbounded) approximate.tmax = visitor.take(*scene.job().unbounded);
  if (!is_valid(approximate)) return;
  const auto take = [](void* to, const BvhLeaf& leaf) { return static_cast<Visit*>(to)->take(leaf); };
  bvh_queries().leaves(scene.job(), approximate, take, &visitor);
}

}  // namespace

void trace_exactly(const BvhScene& scene, const BvhInstances& instances, const Ray& ray, reference::Sink& sink) {
  const reference::LocalRay world(ray);
  visit(scene, {ray, world, nullptr}, ray, sink);
  if (instances.empty()) return;
  instances.for_met(ray, [&](const Instance& instance, const BvhScene& group, const Ray& local) {
    const reference::LocalRay placed(world, instance.to_group);
    visit(group, {ray, placed, &instance}, local, sink);
    return reach(sink);
  });
}

}  // namespace rayengine
