#include "accel/walk.h"

#include <algorithm>
#include <memory>

#include "accel/isa/walk_kernel.h"

namespace rayengine {
WalkSpace walk_space(const Treelets& treelets) {
  WalkSpace space{};
  space.nodes = treelets.nodes.data();
  space.scale = treelets.frame.scale;
  space.inverse_scale = 1 / space.scale;
  const WideNode& root = treelets.nodes.front();
  for (int axis = 0; axis < 3; ++axis) {
    space.center[axis] = treelets.frame.center[axis];
    space.lower[axis] = *std::min_element(root.planes[axis][0], root.planes[axis][0] + WideNode::width);
    space.upper[axis] = *std::max_element(root.planes[axis][1], root.planes[axis][1] + WideNode::width);
  }
  return space;
}

void walk_with(Isa isa, const Treelets& treelets, std::span<const Ray> rays, std::span<WalkCursor> cursors,
               std::uint32_t capacity, std::span<TreeletEntry> lists, std::span<std::uint32_t> counts) {
  if (treelets.treelets.empty()) {
    std::fill_n(cursors.begin(), rays.size(), WalkCursor{WalkCursor::end});
    std::fill_n(counts.begin(), rays.size(), 0);
    return;
  }
  // A ray may have all lanes of all nodes waiting at once, however unlikely; memory that is not touched costs nothing.
  const auto queue = std::make_unique_for_overwrite<std::uint64_t[]>(treelets.nodes.size() * WideNode::width + 64);
  WalkJob job{walk_space(treelets)};
  job.rays = rays.data(), job.ray_count = rays.size();
  job.cursors = cursors.data(), job.capacity = capacity;
  job.lists = lists.data(), job.counts = counts.data(), job.queue = queue.get();
  switch (isa) {
    case Isa::avx512: return avx512::walk(job);
    case Isa::avx2: return avx2::walk(job);
    case Isa::sse2: return sse2::walk(job);
  }
}

void walk(const Treelets& treelets, std::span<const Ray> rays, std::span<WalkCursor> cursors, std::uint32_t capacity,
          std::span<TreeletEntry> lists, std::span<std::uint32_t> counts) {
  walk_with(best_isa(), treelets, rays, cursors, capacity, lists, counts);
}

}  // namespace rayengine
