#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "accel/box.h"

namespace rayengine::reference {

/// A plain binary tree of boxes in double, split at the median of the centres along the widest axis.
class Bvh {
 public:
  /// Boxes must be finite; empty ones are left out. They are widened here by more than the rounding of whoever made
  /// them.
  explicit Bvh(std::span<const Box> boxes);

  /// Which part of a ray is looked at, in double. `slack` widens every box, for rays that are not exactly these
  /// doubles.
  struct Segment {
    glm::dvec3 origin, direction;
    double tmin = 0, slack = 0;
  };

  /// Calls visit(index of a box) for every box that may meet the segment, nearer ones first as far as boxes tell.
  /// `reach()` is where the segment ends; it may shrink from call to call.
  template <class Reach, class Visit>
  void traverse(const Segment& segment, const Reach& reach, const Visit& visit) const;

  const Box& bounds() const { return bounds_; }
  std::size_t bytes() const { return nodes_.capacity() * sizeof(Node) + order_.capacity() * sizeof(std::uint32_t); }

 private:
  /// A leaf has count > 0 and holds order_[first...]; an inner node's children are nodes_[first] and nodes_[first + 1].
  struct Node {
    Box box;
    std::uint32_t first = 0, count = 0;
  };
  struct Entry {
    std::uint32_t node;
    double enter;
  };

  void split(std::uint32_t node, std::span<const Box> boxes);
  /// Where the segment enters a node's box; infinity when it surely misses it.
  static double enter(const Box& box, const Segment& segment, double reach);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
  Box bounds_;
};

template <class Reach, class Visit>
void Bvh::traverse(const Segment& segment, const Reach& reach, const Visit& visit) const {
  if (nodes_.empty()) return;
  Entry stack[64];  // the median halves: no deeper than the bits of an index
  int depth = 0;
  const auto push = [&](const Entry& e) {
    if (e.enter < infinity) stack[depth++] = e;
  };
  push({0, enter(nodes_[0].box, segment, reach())});
  while (depth > 0) {
    const Entry top = stack[--depth];
    if (top.enter > reach()) continue;
    const Node& node = nodes_[top.node];
    for (std::uint32_t i = 0; i < node.count; ++i) visit(order_[node.first + i]);
    if (node.count > 0) continue;
    Entry near{node.first, enter(nodes_[node.first].box, segment, reach())};
    Entry far{node.first + 1, enter(nodes_[node.first + 1].box, segment, reach())};
    if (far.enter < near.enter) std::swap(near, far);
    push(far);
    push(near);
  }
}

}  // namespace rayengine::reference
