#pragma once

#include <vector>

#include "accel/walk.h"
#include "cpu/bvh_scene.h"

namespace rayengine {

/// The instances of a Geometry: a BVH over their boxes, and the scenes of their groups.
class BvhInstances {
 public:
  BvhInstances(const Geometry& geometry, Planeless planeless);

  /// Calls meet(instance, scene of its group, the ray in its space) for the instances that `ray` may hit, by ascending
  /// distance where they have a box. `meet` answers the t beyond which no more are wanted. t is the same in all spaces.
  template <class Meet>
  void for_met(const Ray& ray, Meet&& meet) const;

  bool empty() const { return instances_.empty(); }
  std::size_t bytes() const;

 private:
  template <class Meet>
  double meet_one(std::uint32_t index, const Ray& ray, Meet&& meet) const;

  const std::vector<Instance>& instances_;
  std::vector<std::unique_ptr<BvhScene>> groups_;
  Treelets tree_;  ///< of treelets of one instance each, listed among its quadrics
};

template <class Meet>
double BvhInstances::meet_one(std::uint32_t index, const Ray& ray, Meet&& meet) const {
  const Instance& instance = instances_[index];
  const Ray local{instance.to_group.point(ray.origin), ray.tmin, instance.to_group.vector(ray.direction), ray.tmax};
  return meet(instance, *groups_[instance.group], local);
}

template <class Meet>
void BvhInstances::for_met(const Ray& ray, Meet&& meet) const {
  constexpr std::uint32_t capacity = 8;
  double end = ray.tmax;
  for (std::uint32_t i = 0; i < tree_.unbounded.quadric_count; ++i)
    end = meet_one(tree_.quadrics[tree_.unbounded.first_quadric + i], ray, meet);
  TreeletEntry entries[capacity];
  std::uint32_t count = 0;
  for (WalkCursor cursor; !cursor.finished();) {
    walk(tree_, {&ray, 1}, {&cursor, 1}, capacity, entries, {&count, 1});
    for (std::uint32_t i = 0; i < count; ++i) {
      if (entries[i].t > end) return;
      end = meet_one(tree_.quadrics[tree_.treelets[entries[i].treelet].first_quadric], ray, meet);
    }
  }
}

}  // namespace rayengine
