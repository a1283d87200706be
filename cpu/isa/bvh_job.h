#pragma once

#include <cstddef>
#include <cstdint>

#include "accel/geometry.h"
#include "accel/isa/walk_kernel.h"

namespace rayengine {

/// Eight triangles side by side; places without one hold a degenerate triangle, which nothing hits.
template <class T>
struct alignas(64) TriangleBlock {
  static constexpr std::uint32_t width = 8;

  T corners[3][3][width];   ///< corner, axis, place
  std::uint32_t id[width];  ///< indices into Geometry::triangles
};

struct BvhLeaf {
  std::uint32_t first_block = 0, triangle_count = 0;
  std::uint32_t first_quadric = 0, quadric_count = 0;
};

/// A scene as code built for several instruction sets may touch it.
struct BvhJob : WalkSpace {
  const Geometry* geometry;
  const BvhLeaf* leaves;
  const BvhLeaf* unbounded;                    ///< what every ray is to be tested against; null when there is nothing
  const TriangleBlock<float>* float_blocks;    ///< where all vertices are floats,
  const TriangleBlock<double>* double_blocks;  ///< and where not; the other is null
  const std::uint32_t* quadrics;               ///< indices into Geometry::quadrics
  const std::uint8_t* kinds;                   ///< theirs, see kind_of
};

/// Where a ray was hit.
struct BvhAnswer {
  static constexpr std::uint32_t triangle = 3, miss = 4;

  double t;
  std::uint32_t index;  ///< in Geometry::triangles or Geometry::quadrics
  std::uint32_t part;   ///< 0 side, 1 lower cap, 2 upper cap of a quadric; `triangle`; `miss`
  float u, v;
};

/// Takes what all-hits queries find.
using CollectAnswer = void (*)(void* to, const BvhAnswer& answer);

/// The queries of one instruction set. Rays must be valid; any number of them.
struct BvhQueries {
  void (*closest)(const BvhJob& job, const Ray* rays, std::size_t count, BvhAnswer* answers);
  void (*any)(const BvhJob& job, const Ray* rays, std::size_t count, std::uint32_t* status);
  void (*all)(const BvhJob& job, const Ray& ray, CollectAnswer collect, void* to);
};

namespace sse2 {
extern const BvhQueries bvh_queries;
}
namespace avx2 {
extern const BvhQueries bvh_queries;
}
namespace avx512 {
extern const BvhQueries bvh_queries;
}

}  // namespace rayengine
