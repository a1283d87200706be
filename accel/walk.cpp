#include "accel/walk.h"

#include <algorithm>
#include <memory>

#include "accel/isa/isa.h"
#include "accel/isa/walk_kernel.h"

namespace rayengine {
namespace {

void set_bounds(WalkJob& job, const WideNode& root) {
  for (int axis = 0; axis < 3; ++axis) {
    job.lower[axis] = *std::min_element(root.planes[axis][0], root.planes[axis][0] + WideNode::width);
    job.upper[axis] = *std::max_element(root.planes[axis][1], root.planes[axis][1] + WideNode::width);
  }
}

}  // namespace

void walk(const Treelets& treelets, std::span<const Ray> rays, std::span<WalkCursor> cursors, std::uint32_t capacity,
          std::span<TreeletEntry> lists, std::span<std::uint32_t> counts) {
  // A ray may have all lanes of all nodes waiting at once, however unlikely; memory that is not touched costs nothing.
  const auto queue = std::make_unique_for_overwrite<std::uint64_t[]>(treelets.nodes.size() * WideNode::width + 2);
  WalkJob job{treelets.nodes.data(), {},          treelets.frame.scale, {},       {},
              rays.data(),           rays.size(), cursors.data(),       capacity, lists.data(),
              counts.data(),         queue.get()};
  for (int axis = 0; axis < 3; ++axis) job.center[axis] = treelets.frame.center[axis];
  set_bounds(job, treelets.nodes.front());
  switch (best_isa()) {
    case Isa::avx512: return avx512::walk(job);
    case Isa::avx2: return avx2::walk(job);
    case Isa::sse2: return sse2::walk(job);
  }
}

}  // namespace rayengine
