#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "cpu/bvh_scene.h"
#include "cpu/instance_walk.h"

namespace rayengine {

/// Rays that may hit an instance, by their places among those asked about.
struct Meeting {
  const Instance& instance;
  const BvhScene& group;
  std::span<const InstanceWalk::Pair> pairs;

  /// The ray in the space of the group, where t is what it is in the world.
  Ray placed(const Ray& ray) const {
    return {instance.to_group.point(ray.origin), ray.tmin, instance.to_group.vector(ray.direction), ray.tmax};
  }
};

/// The rays of a meeting in the space of its group, as far as their ends: those that may be traced there, and the
/// others. To be used again, since to make this takes longer than to trace a few rays.
struct PlacedRays {
  /// may(group, ray in its space)
  template <class May>
  void place(const Meeting& meeting, std::span<const Ray> asked, std::span<const double> ends, May&& may) {
    count = other_count = 0;
    for (const InstanceWalk::Pair& pair : meeting.pairs) {
      Ray& ray = rays[count] = meeting.placed(asked[pair.ray]);
      ray.tmax = std::min(ray.tmax, ends[pair.ray]);
      if (may(meeting.group, ray))
        number[count++] = pair.ray;
      else
        other[other_count++] = pair.ray;
    }
  }

  template <class T>
  using EachRay = std::array<T, InstanceWalk::most_rays>;

  EachRay<Ray> rays;
  EachRay<std::uint32_t> number, other;  ///< places among the rays asked about
  std::size_t count = 0, other_count = 0;
};

/// Calls work(first, count) for so many rays at a time as can meet instances together.
template <class Work>
void for_blocks(std::size_t rays, Work&& work) {
  for (std::size_t first = 0; first < rays; first += InstanceWalk::most_rays)
    work(first, std::min(InstanceWalk::most_rays, rays - first));
}

/// The instances of a Geometry: a BVH over their boxes, and the scenes of their groups.
class BvhInstances {
 public:
  BvhInstances(const Geometry& geometry, Planeless planeless);

  /// Calls meet(Meeting) for the instances that at most InstanceWalk::most_rays rays may hit, for each by ascending
  /// distance where they have a box.
  /// ends[i] is the t beyond which ray i wants no more, below its tmin if it wants nothing; `meet` may lower it.
  template <class Meet>
  void for_met(std::span<const Ray> rays, std::span<const double> ends, Meet&& meet) const;

  /// For any-hit queries of any number of rays: meet(Meeting, rays, ends, status) for those that missed so far, at most
  /// InstanceWalk::most_rays of them together; places in the meeting are those in the three spans.
  template <class Meet>
  void for_missed(std::span<const Ray> rays, std::span<std::uint32_t> status, Meet&& meet) const;

  /// For one ray: meet(instance, scene of its group, the ray in its space) answers the end.
  template <class Meet>
  void for_met(const Ray& ray, Meet&& meet) const;

  bool empty() const { return instances_.empty(); }
  std::size_t bytes() const;

 private:
  const std::vector<Instance>& instances_;
  std::vector<std::unique_ptr<BvhScene>> groups_;
  Treelets tree_;  ///< of treelets of one instance each, listed among its quadrics
};

template <class Meet>
void BvhInstances::for_met(std::span<const Ray> rays, std::span<const double> ends, Meet&& meet) const {
  InstanceWalk walk(tree_, rays, ends);
  for (auto pairs = walk.next(); !pairs.empty(); pairs = walk.next())
    while (!pairs.empty()) {
      const std::uint32_t index = pairs.front().instance;
      const auto others = [=](const InstanceWalk::Pair& pair) { return pair.instance != index; };
      const auto count = static_cast<std::size_t>(std::ranges::find_if(pairs, others) - pairs.begin());
      meet(Meeting{instances_[index], *groups_[instances_[index].group], pairs.first(count)});
      pairs = pairs.subspan(count);
    }
}

template <class Meet>
void BvhInstances::for_missed(std::span<const Ray> rays, std::span<std::uint32_t> status, Meet&& meet) const {
  for_blocks(rays.size(), [&](std::size_t first, std::size_t count) {
    const auto mine = rays.subspan(first, count);
    const auto answers = status.subspan(first, count);
    std::array<double, InstanceWalk::most_rays> room;
    const auto ends = std::span(room).first(count);
    for (std::size_t i = 0; i < count; ++i) ends[i] = answers[i] == status_miss ? mine[i].tmax : -infinity;
    for_met(mine, ends, [&](const Meeting& meeting) { meet(meeting, mine, ends, answers); });
  });
}

template <class Meet>
void BvhInstances::for_met(const Ray& ray, Meet&& meet) const {
  double end = ray.tmax;
  for_met({&ray, 1}, {&end, 1}, [&](const Meeting& m) { end = meet(m.instance, m.group, m.placed(ray)); });
}

}  // namespace rayengine
