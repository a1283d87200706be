#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "accel/bvh.h"
#include "accel/geometry.h"

namespace rayengine {

/// What treelets are built over: triangles and quadrics alike.
struct TreeletPrimitive {
  static constexpr std::uint32_t triangle = 0xFFFFFFFFu;

  Box bounds;
  std::uint32_t type = triangle;  ///< `triangle`, or the QuadricType
  std::uint32_t id = 0;           ///< the caller's: see Treelets::triangles and Treelets::quadrics

  /// Whether a structure can hold it; what has no end must be tested against every ray.
  bool bounded() const;
};

/// The triangles and quadrics that `geometry` itself holds (not its instances); ids are indices into
/// Geometry::triangles and Geometry::quadrics. Bounds hold the surface as single and double precision see it.
std::vector<TreeletPrimitive> treelet_primitives(const Geometry& geometry);

/// Ranges of Treelets::triangles and Treelets::quadrics.
struct Treelet {
  std::uint32_t first_triangle = 0, triangle_count = 0;
  std::uint32_t first_quadric = 0, quadric_count = 0;  ///< by ascending type

  std::uint32_t size() const { return triangle_count + quadric_count; }
};
static_assert(sizeof(Treelet) == 16);

/// A BVH cut where a subtree holds at most K primitives: rays are taken through the levels above the cut (see walk.h),
/// and tested against all that a treelet holds. Immutable once built.
struct Treelets {
  LocalFrame frame;             ///< of the boxes in `nodes`
  std::vector<WideNode> nodes;  ///< the levels above the cut; leaves are indices into `treelets`
  std::vector<Treelet> treelets;
  Treelet unbounded;  ///< what no box holds: to be tested against every ray, and never listed by a walk

  std::vector<std::uint32_t> triangles;  ///< ids, contiguous by treelet, those of `unbounded` last
  std::vector<std::uint32_t> quadrics;  ///< ids, contiguous by treelet and by type within it, those of `unbounded` last

  std::size_t bytes() const;
};

/// The bounds of all in `geometry` that has an end, as exact as its vertices: what a frame is best taken from, since a
/// scene that is symmetric stays so in it, and rays that hit two primitives at once do so in single precision, too.
Box frame_bounds(const Geometry& geometry);

/// Appends the primitives whose indices are `members` as one treelet, in the order of their types and ids, which
/// `members` then has as well.
Treelet append_treelet(Treelets& to, std::span<const TreeletPrimitive> primitives, std::span<std::uint32_t> members);

/// Every primitive lands in exactly one treelet, or in `unbounded`. The frame is that of the primitives' bounds, or of
/// `about` where it is not empty. Throws Error when K is 0, or there is no memory.
Treelets build_treelets(std::span<const TreeletPrimitive> primitives, std::uint32_t K, const Box& about = {});

/// No structure: all primitives in `unbounded`, triangles in their order, quadrics by type.
Treelets list_all(const Geometry& geometry);

}  // namespace rayengine
