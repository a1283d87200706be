#include "cpu/bvh_instances.h"

namespace rayengine {

BvhInstances::BvhInstances(const Geometry& geometry, Planeless planeless) : instances_(geometry.instances) {
  for (const auto& group : geometry.groups) groups_.push_back(std::make_unique<BvhScene>(group, planeless));
  std::vector<TreeletPrimitive> boxes;
  for (const Instance& instance : instances_)
    boxes.push_back({bounds(geometry, instance), 0, static_cast<std::uint32_t>(boxes.size())});
  tree_ = build_treelets(boxes, 1);
}

std::size_t BvhInstances::bytes() const {
  std::size_t sum = tree_.bytes();
  for (const auto& group : groups_) sum += group->bytes();
  return sum;
}

}  // namespace rayengine
