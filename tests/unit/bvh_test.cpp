#include "accel/bvh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "accel/ray.h"

using namespace rayengine;

namespace {

std::vector<Box> random_boxes(std::size_t count, glm::dvec3 offset, double scale) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Box> boxes(count);
  for (Box& box : boxes)
    for (int corner = 0; corner < 2; ++corner)
      box.add(offset + scale * glm::dvec3(unit(random), unit(random), 0.01 * unit(random)));
  return boxes;
}

bool holds(const FloatBox& outer, const Box& inner, const LocalFrame& frame) {
  for (int i = 0; i < 3; ++i) {
    // In more than double, so that the test does not round as the code does.
    const long double lower = (static_cast<long double>(inner.lower[i]) - frame.center[i]) * frame.scale;
    const long double upper = (static_cast<long double>(inner.upper[i]) - frame.center[i]) * frame.scale;
    if (outer.lower[i] > lower || outer.upper[i] < upper) return false;
  }
  return true;
}

void expect_sound(const std::vector<Box>& boxes, std::uint32_t leaf_size) {
  const BinaryBvh bvh = build_bvh(boxes, leaf_size);
  std::vector<std::uint32_t> sorted = bvh.order, all(boxes.size());
  std::sort(sorted.begin(), sorted.end());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(sorted, all) << "every box stands in exactly one leaf";
  for (std::uint32_t i = 0; i < bvh.nodes.size(); ++i) {
    const BinaryBvh::Node& node = bvh.nodes[i];
    for (std::uint32_t k = 0; k < node.count; ++k)
      ASSERT_TRUE(holds(node.box, boxes[bvh.order[node.first + k]], bvh.frame)) << "node " << i;
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_GE(node.box.lower[axis], -1);
      ASSERT_LE(node.box.upper[axis], 1);
    }
    if (node.leaf()) {
      ASSERT_LE(node.count, leaf_size);
      continue;
    }
    const BinaryBvh::Node &left = bvh.nodes[i + 1], &right = bvh.nodes[node.right];
    ASSERT_EQ(left.first, node.first);
    ASSERT_EQ(right.first, left.first + left.count);
    ASSERT_EQ(left.count + right.count, node.count);
  }
}

}  // namespace

TEST(Bvh, HoldsEveryBoxOnce) { expect_sound(random_boxes(3000, {}, 1), 4); }

TEST(Bvh, StandsAnyPlaceAndScale) {
  for (const double scale : {1e-290, 1e-20, 1e20, 1e290})
    for (const double offset : {0.0, 3.0, 1e9})
      expect_sound(random_boxes(200, glm::dvec3(offset, -offset, offset) * scale, scale), 1);
}

TEST(Bvh, SplitsBoxesThatCoincide) { expect_sound(std::vector<Box>(5000, Box{{1, 2, 3}, {1, 2, 4}}), 8); }

TEST(Bvh, SplitsBoxesNestedOverTheWholeRangeOfFloats) {
  std::vector<Box> boxes;
  for (int e = -120; e <= 120; ++e) boxes.push_back({glm::dvec3(std::ldexp(1, e)), glm::dvec3(std::ldexp(1.5, e))});
  expect_sound(boxes, 1);
}

TEST(Bvh, OfAPointOrOfNothing) {
  expect_sound({Box{{5e5, 0, -3}, {5e5, 0, -3}}}, 1);
  EXPECT_TRUE(build_bvh({}, 1).nodes.empty());
  EXPECT_EQ(widen(build_bvh({}, 1), [](std::uint32_t) { return no_id; }).size(), 1u);
}

TEST(Bvh, WideNodesReachEveryLeafOnceWithItsBox) {
  const std::vector<Box> boxes = random_boxes(1000, {}, 1);
  const BinaryBvh bvh = build_bvh(boxes, 2);
  const auto leaf_of = [&](std::uint32_t i) { return bvh.nodes[i].leaf() ? i : no_id; };
  const std::vector<WideNode> nodes = widen(bvh, leaf_of);
  std::vector<int> reached(bvh.nodes.size()), opened(nodes.size());
  opened[0] = 1;
  for (const WideNode& node : nodes)
    for (std::uint32_t lane = 0; lane < WideNode::width; ++lane) {
      if (node.planes[0][0][lane] > node.planes[0][1][lane]) continue;
      const std::uint32_t child = node.children[lane];
      if (!(child & WideNode::leaf)) {
        ++opened[child];
        continue;
      }
      const std::uint32_t leaf = child ^ WideNode::leaf;
      ++reached[leaf];
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(node.planes[axis][0][lane], bvh.nodes[leaf].box.lower[axis]);
        EXPECT_EQ(node.planes[axis][1][lane], bvh.nodes[leaf].box.upper[axis]);
      }
    }
  for (std::uint32_t i = 0; i < bvh.nodes.size(); ++i) EXPECT_EQ(reached[i], bvh.nodes[i].leaf() ? 1 : 0);
  EXPECT_EQ(opened, std::vector<int>(nodes.size(), 1));
}
