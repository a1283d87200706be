#include <algorithm>
#include <array>

#include "accel/bvh.h"
#include "accel/ray.h"

namespace rayengine {
namespace {

using LeafOf = std::function<std::uint32_t(std::uint32_t)>;

constexpr auto width = WideNode::width;

/// Which levels to merge so that rays open the fewest nodes, by the surface area heuristic. Source of the method:
/// Ylitie, Karras, Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs" (HPG 2017),
/// section 4.1.
class Merging {
 public:
  Merging(const BinaryBvh& bvh, const LeafOf& leaf_of) : bvh_(bvh), leaf_of_(leaf_of), plans_(bvh.nodes.size()) {
    for (auto i = static_cast<std::uint32_t>(plans_.size()); i-- > 0;) plans_[i] = plan(i);
  }

  /// The binary nodes that become the children of the wide node that `root` becomes.
  std::vector<std::uint32_t> children(std::uint32_t root) const {
    std::vector<std::uint32_t> result;
    if (leaf_of_(root) != no_id)
      result.push_back(root);
    else
      split(root, width, result);
    return result;
  }

 private:
  /// For a node's subtree, by the number of lanes at hand less one: the expected number of wide nodes opened in it, and
  /// how many of the lanes go to the left child; none when the subtree is better a wide node of its own, in one lane.
  struct Plan {
    std::array<float, width> cost{};
    std::array<std::uint8_t, width> left{};
  };

  Plan plan(std::uint32_t i) const {
    Plan p;
    const BinaryBvh::Node& node = bvh_.nodes[i];
    if (node.leaf() || leaf_of_(i) != no_id) return p;
    const Plan &a = plans_[i + 1], &b = plans_[node.right];
    for (std::uint32_t lanes = 2; lanes <= width; ++lanes) {
      p.cost[lanes - 1] = a.cost[0] + b.cost[lanes - 2];
      p.left[lanes - 1] = 1;
      for (std::uint32_t left = 2; left < lanes; ++left) {
        const float cost = a.cost[left - 1] + b.cost[lanes - left - 1];
        if (cost >= p.cost[lanes - 1]) continue;
        p.cost[lanes - 1] = cost;
        p.left[lanes - 1] = static_cast<std::uint8_t>(left);
      }
    }
    p.cost[0] = node.box.half_area() + p.cost[width - 1];
    for (std::uint32_t lanes = 2; lanes < width; ++lanes)
      if (p.cost[0] <= p.cost[lanes - 1]) p.cost[lanes - 1] = p.cost[0], p.left[lanes - 1] = 0;
    return p;
  }

  void distribute(std::uint32_t i, std::uint32_t lanes, std::vector<std::uint32_t>& result) const {
    if (leaf_of_(i) != no_id || plans_[i].left[lanes - 1] == 0)
      result.push_back(i);
    else
      split(i, lanes, result);
  }

  void split(std::uint32_t i, std::uint32_t lanes, std::vector<std::uint32_t>& result) const {
    const std::uint32_t left = plans_[i].left[lanes - 1];
    distribute(i + 1, left, result);
    distribute(bvh_.nodes[i].right, lanes - left, result);
  }

  const BinaryBvh& bvh_;
  const LeafOf& leaf_of_;
  std::vector<Plan> plans_;
};

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
  if (bvh.nodes.empty()) return nodes;
  const Merging merging(bvh, leaf_of);
  std::vector<std::uint32_t> source{0};  // the binary node that each wide one opens
  for (std::size_t i = 0; i < source.size(); ++i) {
    std::uint32_t lane = 0;
    for (const std::uint32_t child : merging.children(source[i])) {
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
