#include "accel/bvh.h"

#include <embree3/rtcore.h>

#include <array>
#include <cmath>
#include <memory>
#include <type_traits>

#include "accel/tracer.h"

namespace rayengine {
namespace {

float rounded_down(double x) {
  const float f = static_cast<float>(x);
  return f > x ? std::nextafter(f, -HUGE_VALF) : f;
}
float rounded_up(double x) { return -rounded_down(-x); }

template <class T, auto Release>
struct Releaser {
  void operator()(T* object) const { Release(object); }
};
template <class Handle, auto Release>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Releaser<std::remove_pointer_t<Handle>, Release>>;
using Device = Owned<RTCDevice, rtcReleaseDevice>;
using EmbreeBuilder = Owned<RTCBVH, rtcReleaseBVH>;

/// What Embree's callbacks make, in memory that Embree holds until its builder is released.
struct BuiltNode {
  std::array<const BuiltNode*, 2> children{};
  const std::uint32_t* indices = nullptr;  ///< a leaf's
  std::size_t count = 0;
};

void* create_node(RTCThreadLocalAllocator allocator, unsigned, void*) {
  return new (rtcThreadLocalAlloc(allocator, sizeof(BuiltNode), alignof(BuiltNode))) BuiltNode;
}

void set_children(void* node, void** children, unsigned count, void*) {
  for (unsigned i = 0; i < count; ++i)
    static_cast<BuiltNode*>(node)->children[i] = static_cast<BuiltNode*>(children[i]);
}

/// Bounds are worked out from the leaves up instead (see finish), in our rounding.
void ignore_bounds(void*, const RTCBounds**, unsigned, void*) {}

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, std::size_t count, void*) {
  auto* indices = static_cast<std::uint32_t*>(
      rtcThreadLocalAlloc(allocator, count * sizeof(std::uint32_t), alignof(std::uint32_t)));
  for (std::size_t i = 0; i < count; ++i) indices[i] = primitives[i].primID;
  return new (rtcThreadLocalAlloc(allocator, sizeof(BuiltNode), alignof(BuiltNode))) BuiltNode{{}, indices, count};
}

RTCBuildArguments arguments(RTCBVH builder, std::vector<RTCBuildPrimitive>& primitives, std::uint32_t leaf_size) {
  RTCBuildArguments a = rtcDefaultBuildArguments();
  a.maxBranchingFactor = 2;
  a.maxDepth = 256;  // more than boxes nested as deep as floats go can need
  a.maxLeafSize = leaf_size;
  a.bvh = builder;
  a.primitives = primitives.data();
  a.primitiveCount = a.primitiveArrayCapacity = primitives.size();
  a.createNode = create_node;
  a.setNodeChildren = set_children;
  a.setNodeBounds = ignore_bounds;
  a.createLeaf = create_leaf;
  return a;
}

/// Copies the subtree in depth-first order; boxes are left empty.
void append(BinaryBvh& bvh, const BuiltNode& built) {
  const auto index = bvh.nodes.size();
  bvh.nodes.emplace_back().first = static_cast<std::uint32_t>(bvh.order.size());
  bvh.order.insert(bvh.order.end(), built.indices, built.indices + built.count);
  if (!built.indices) {
    append(bvh, *built.children[0]);
    bvh.nodes[index].right = static_cast<std::uint32_t>(bvh.nodes.size());
    append(bvh, *built.children[1]);
  }
  bvh.nodes[index].count = static_cast<std::uint32_t>(bvh.order.size()) - bvh.nodes[index].first;
}

void fit_boxes(BinaryBvh& bvh, const std::vector<FloatBox>& boxes) {
  for (std::size_t i = bvh.nodes.size(); i-- > 0;) {
    BinaryBvh::Node& node = bvh.nodes[i];
    if (node.leaf()) {
      for (std::uint32_t k = 0; k < node.count; ++k) node.box.add(boxes[bvh.order[node.first + k]]);
    } else {
      node.box.add(bvh.nodes[i + 1].box);
      node.box.add(bvh.nodes[node.right].box);
    }
  }
}

RTCBuildPrimitive build_primitive(const FloatBox& b, std::size_t index) {
  return {b.lower.x, b.lower.y, b.lower.z, 0, b.upper.x, b.upper.y, b.upper.z, static_cast<unsigned>(index)};
}

}  // namespace

LocalFrame::LocalFrame(const Box& bounds) {
  if (bounds.empty()) return;
  center = 0.5 * bounds.lower + 0.5 * bounds.upper;
  const glm::dvec3 reach = glm::max(bounds.upper - center, center - bounds.lower);
  const double largest = std::max({reach.x, reach.y, reach.z});
  // No larger than 2^1000, so that a scene of a single point keeps finite numbers.
  scale = std::ldexp(1, largest > 0 ? std::min(-1 - std::ilogb(largest), 1000) : 0);
}

FloatBox::FloatBox(const Box& box, const LocalFrame& frame) {
  const glm::dvec3 lo = (box.lower - frame.center) * frame.scale, up = (box.upper - frame.center) * frame.scale;
  // The subtraction rounds by less than 2^-53 of a number below 2.
  for (int i = 0; i < 3; ++i) {
    lower[i] = rounded_down(lo[i] - 0x1p-52);
    upper[i] = rounded_up(up[i] + 0x1p-52);
  }
}

float FloatBox::half_area() const {
  const glm::vec3 size = upper - lower;
  return size.x * size.y + size.y * size.z + size.z * size.x;
}

BinaryBvh build_bvh(std::span<const Box> boxes, std::uint32_t leaf_size, const Box& about) {
  BinaryBvh bvh;
  if (boxes.empty()) return bvh;
  Box all = about;
  if (all.empty())
    for (const Box& box : boxes) all.add(box);
  bvh.frame = LocalFrame(all);

  std::vector<FloatBox> local;
  local.reserve(boxes.size());
  std::vector<RTCBuildPrimitive> primitives;
  primitives.reserve(boxes.size());
  for (const Box& box : boxes) {
    local.emplace_back(box, bvh.frame);
    primitives.push_back(build_primitive(local.back(), primitives.size()));
  }

  const Device device(rtcNewDevice(nullptr));
  if (!device) throw Error("Embree gave no device: check that its library is installed and runs on this machine");
  const EmbreeBuilder builder(rtcNewBVH(device.get()));
  const RTCBuildArguments a = arguments(builder.get(), primitives, leaf_size);
  const auto* root = static_cast<const BuiltNode*>(rtcBuildBVH(&a));
  if (!root)
    throw Error("Embree could not build a BVH over " + std::to_string(boxes.size()) +
                " primitives: is there enough memory?");
  bvh.order.reserve(boxes.size());
  append(bvh, *root);
  fit_boxes(bvh, local);
  return bvh;
}

}  // namespace rayengine
