#pragma once

#include <cstddef>
#include <cstdint>

#include "accel/bvh.h"
#include "accel/isa/isa.h"
#include "accel/walk.h"

namespace rayengine {

/// A tree of nodes and where it stands, in the plain types that code built for several instruction sets may touch.
struct WalkSpace {
  const WideNode* nodes;
  double center[3], scale, inverse_scale;  ///< of the local frame
  double lower[3], upper[3];               ///< bounds of all nodes, in the local frame
};

/// `nodes` must not be empty.
WalkSpace walk_space(const Treelets& treelets);

/// A call of walk().
struct WalkJob : WalkSpace {
  const Ray* rays;
  std::size_t ray_count;
  WalkCursor* cursors;
  std::uint32_t capacity;
  TreeletEntry* lists;
  std::uint32_t* counts;
  std::uint64_t* queue;  ///< room for as many as the nodes have lanes, and one
};

/// walk() with a given instruction set, which the machine must have.
void walk_with(Isa isa, const Treelets& treelets, std::span<const Ray> rays, std::span<WalkCursor> cursors,
               std::uint32_t capacity, std::span<TreeletEntry> lists, std::span<std::uint32_t> counts);

namespace sse2 {
void walk(const WalkJob& job);
}
namespace avx2 {
void walk(const WalkJob& job);
}
namespace avx512 {
void walk(const WalkJob& job);
}

}  // namespace rayengine
