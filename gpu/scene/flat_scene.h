#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "accel/geometry.h"

namespace rayengine {

/// A geometry without instances: what they place is copied into world space, since treelets hold primitives themselves.
/// The rank of a primitive numbers the primitives of all objects in order; comparing ranks compares (object,
/// primitive).
struct FlatScene {
  std::shared_ptr<const Geometry> geometry;
  std::vector<std::uint32_t> triangle_ranks;  ///< one per triangle of `geometry`
  std::vector<std::uint32_t> quadric_ranks;   ///< one per quadric: of its side, which its caps follow
};

/// Throws Error, naming `embree`, when there are instances and more than `limit` primitives would result.
FlatScene flatten(std::shared_ptr<const Geometry> geometry, std::size_t limit = std::size_t{1} << 24);

struct Ids {
  std::uint32_t object, primitive;
};

/// The primitive of the original geometry that has a rank.
Ids ids_of_rank(const Geometry& geometry, std::uint32_t rank);

}  // namespace rayengine
