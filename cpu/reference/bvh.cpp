#include "cpu/reference/bvh.h"

#include <algorithm>

#include "accel/kernels/kernels.h"

namespace rayengine::reference {
namespace {

constexpr double padding = 0x1p-36;
constexpr std::uint32_t leaf_size = 2;

Box widened(const Box& box, double by) { return {box.lower - by, box.upper + by}; }

int widest_axis(const Box& box) {
  const glm::dvec3 size = box.size();
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

kernels::Vec3<double> vec(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

Bvh::Bvh(std::span<const Box> boxes) {
  for (std::uint32_t i = 0; i < boxes.size(); ++i)
    if (!boxes[i].empty()) order_.push_back(i), bounds_.add(boxes[i]);
  if (order_.empty()) return;
  nodes_.reserve(order_.size());
  nodes_.push_back({{}, 0, static_cast<std::uint32_t>(order_.size())});
  for (std::uint32_t node = 0; node < nodes_.size(); ++node) split(node, boxes);
}

void Bvh::split(std::uint32_t node, std::span<const Box> boxes) {
  const std::uint32_t first = nodes_[node].first, count = nodes_[node].count;
  const auto begin = order_.begin() + first, end = begin + count;
  Box box, centers;
  std::for_each(begin, end, [&](std::uint32_t i) { box.add(boxes[i]), centers.add(boxes[i].center()); });
  nodes_[node].box = widened(box, padding * box.extent());
  if (count <= leaf_size) return;
  const int axis = widest_axis(centers);
  const auto middle = begin + count / 2;
  std::nth_element(begin, middle, end,
                   [&](std::uint32_t a, std::uint32_t b) { return boxes[a].center()[axis] < boxes[b].center()[axis]; });
  nodes_[node].first = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].count = 0;
  nodes_.push_back({{}, first, count / 2});
  nodes_.push_back({{}, first + count / 2, count - count / 2});
}

double Bvh::enter(const Box& box, const Segment& segment, double reach) {
  const Box wide = widened(box, segment.slack);
  double enter, leave;
  kernels::box(vec(wide.lower), vec(wide.upper), vec(segment.origin), vec(segment.direction), segment.tmin, reach,
               1 + 0x1p-48, enter, leave);
  return enter <= leave ? enter : infinity;
}

}  // namespace rayengine::reference
