#include <algorithm>

#include "accel/bvh.h"
#include "accel/ray.h"

namespace rayengine {
namespace {

using LeafOf = std::function<std::uint32_t(std::uint32_t)>;

constexpr auto width = WideNode::width;

/// The binary nodes that become one wide node's children: of those not yet at the cut, the one that a ray meets most
/// likely is replaced by its two children, until the lanes are full.
std::vector<std::uint32_t> gather(const BinaryBvh& bvh, std::uint32_t root, const LeafOf& leaf_of) {
  std::vector<std::uint32_t> children{root};
  while (children.size() < width) {
    auto widest = children.end();
    for (auto it = children.begin(); it != children.end(); ++it)
      if (leaf_of(*it) == no_id &&
          (widest == children.end() || bvh.nodes[*it].box.half_area() > bvh.nodes[*widest].box.half_area()))
        widest = it;
    if (widest == children.end()) break;
    const std::uint32_t opened = *widest;
    *widest = opened + 1;
    children.push_back(bvh.nodes[opened].right);
  }
  return children;
}

void set_lane(WideNode& node, std::uint32_t lane, const FloatBox& box, std::uint32_t child) {
  for (int axis = 0; axis < 3; ++axis) {
    node.planes[axis][0][lane] = box.lower[axis];
    node.planes[axis][1][lane] = box.upper[axis];
  }
  node.children[lane] = child;
}

WideNode empty_node() {
  WideNode node{};
  for (std::uint32_t lane = 0; lane < width; ++lane) set_lane(node, lane, {}, WideNode::leaf);
  return node;
}

}  // namespace

std::vector<WideNode> widen(const BinaryBvh& bvh, const LeafOf& leaf_of) {
  std::vector<WideNode> nodes{empty_node()};
  std::vector<std::uint32_t> source{0};  // the binary node that each wide one opens
  for (std::size_t i = 0; i < source.size() && !bvh.nodes.empty(); ++i) {
    std::uint32_t lane = 0;
    for (const std::uint32_t child : gather(bvh, source[i], leaf_of)) {
      const std::uint32_t leaf = leaf_of(child);
      const std::uint32_t reference = leaf == no_id ? static_cast<std::uint32_t>(nodes.size()) : WideNode::leaf | leaf;
      set_lane(nodes[i], lane++, bvh.nodes[child].box, reference);
      if (leaf != no_id) continue;
      nodes.push_back(empty_node());
      source.push_back(child);
    }
  }
  return nodes;
}

}  // namespace rayengine
