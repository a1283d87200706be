#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "accel/box.h"

namespace rayengine {

/// The coordinates of a BVH: (p - center) * scale, in which all it holds lies in [-1, 1]^3. Single precision boxes are
/// as good far from the world's origin as near it, and no scene is too large or too small for them. `scale` is a power
/// of two.
struct LocalFrame {
  glm::dvec3 center{0};
  double scale = 1;

  LocalFrame() = default;
  explicit LocalFrame(const Box& bounds);
};

/// A box in a LocalFrame, rounded outward; empty until something is added.
struct FloatBox {
  glm::vec3 lower{static_cast<float>(infinity)};
  glm::vec3 upper{-static_cast<float>(infinity)};

  FloatBox() = default;
  FloatBox(const Box& box, const LocalFrame& frame);
  void add(const FloatBox& b) { lower = glm::min(lower, b.lower), upper = glm::max(upper, b.upper); }
  float half_area() const;
};

/// A binary BVH in depth-first order: a node's left child follows it, and its subtree holds order[first, first +
/// count).
struct BinaryBvh {
  struct Node {
    FloatBox box;
    std::uint32_t right = 0;  ///< index of the right child; 0 in a leaf
    std::uint32_t first = 0, count = 0;
    bool leaf() const { return right == 0; }
  };
  LocalFrame frame;
  std::vector<Node> nodes;           ///< the root first; none when there are no primitives
  std::vector<std::uint32_t> order;  ///< indices into the boxes that it was built over
};

/// Builds over finite boxes by Embree's binned surface area heuristic, each box in exactly one leaf, leaves of at most
/// `leaf_size` (1 to 32) boxes. The frame is that of all boxes, or of `about` where it is not empty: it should be much
/// the same. Throws Error when Embree cannot.
BinaryBvh build_bvh(std::span<const Box> boxes, std::uint32_t leaf_size, const Box& about = {});

/// Eight boxes side by side for SIMD. Lanes that are not used hold empty boxes, which no ray meets.
struct alignas(64) WideNode {
  static constexpr std::uint32_t width = 8;
  static constexpr std::uint32_t leaf = 0x80000000u;  ///< marks a child that is a leaf; the other bits are its number

  float planes[3][2][width];      ///< by axis, then lower and upper
  std::uint32_t children[width];  ///< an index of a node, or of a leaf
};
static_assert(sizeof(WideNode) == 256);

/// Merges the levels of a binary BVH above its cut into wide nodes, the root first. `leaf_of(i)` says which leaf the
/// binary node i becomes, or no_id when it is above the cut; it must name one for every binary leaf. At least one node
/// results.
std::vector<WideNode> widen(const BinaryBvh& bvh, const std::function<std::uint32_t(std::uint32_t)>& leaf_of);

}  // namespace rayengine
