#pragma once

#include <cstddef>
#include <cstdint>

#include "accel/geometry.h"
#include "accel/isa/walk_kernel.h"

namespace rayengine {

/// Eight triangles side by side; places without one hold NaN, which nothing hits.
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
  const double* norms;                         ///< theirs: the largest row sum of the magnitudes of to_object.linear
  double corner_lower[3], corner_upper[3];     ///< bounds of all corners of triangles
};

/// Bounds on how far a ray's components are off, before any of the arithmetic here.
struct RayError {
  double origin = 0, direction = 0;
};

/// Where a ray was hit.
struct BvhAnswer {
  static constexpr std::uint32_t triangle = 3, miss = 4;

  double t, error;      ///< |t - exact t| <= error where the query certifies
  std::uint32_t index;  ///< in Geometry::triangles or Geometry::quadrics
  std::uint32_t part;   ///< 0 side, 1 lower cap, 2 upper cap of a quadric; `triangle`; `miss`
  float u, v;
  bool unsure = false;  ///< of queries that certify: double precision cannot tell
};

/// Takes what all-hits queries find.
using CollectAnswer = void (*)(void* to, const BvhAnswer& answer);

/// What any-hit queries that certify write where double precision cannot tell.
constexpr std::uint32_t status_unsure = ~0u;

/// Takes a leaf with a box that a ray may meet, and answers the t beyond which no more are wanted.
using TakeLeaf = double (*)(void* to, const BvhLeaf& leaf);

/// The queries of one instruction set. Rays must be valid; any number of them. Those that certify need rays, and
/// scenes, whose numbers are moderate: see is_moderate; `errors` are null, or one a ray. Every answer of theirs is that
/// of exact arithmetic or unsure.
struct BvhQueries {
  void (*closest)(const BvhJob& job, const Ray* rays, std::size_t count, BvhAnswer* answers);
  void (*any)(const BvhJob& job, const Ray* rays, std::size_t count, std::uint32_t* status);
  void (*all)(const BvhJob& job, const Ray& ray, CollectAnswer collect, void* to);
  void (*certain_closest)(const BvhJob& job, const Ray* rays, std::size_t count, const RayError* errors,
                          BvhAnswer* answers);
  void (*certain_any)(const BvhJob& job, const Ray* rays, std::size_t count, const RayError* errors,
                      std::uint32_t* status);
  void (*certain_all)(const BvhJob& job, const Ray& ray, const RayError& error, CollectAnswer collect, void* to);
  void (*leaves)(const BvhJob& job, const Ray& ray, TakeLeaf take, void* to);
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
