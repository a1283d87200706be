#pragma once

#include <cstdint>
#include <vector>

#include "accel/geometry.h"

namespace rayengine {

/// An object that is an earlier one placed anew: `object` is from_first(first), vertex by vertex, within `error`.
struct Repeat {
  std::uint32_t first = 0, object = 0;
  Affine from_first;
  double error = 0;  ///< the largest distance of a vertex, hence of a point; 0: equal, without any rounding
};

/// Smaller meshes are as well copied (measured, see docs/plan.md).
inline constexpr std::uint32_t fewest_repeated_triangles = 256;

/// What a ray takes among instances, against what it takes among copies of the same meshes, about: the worst of primary
/// and shadow rays that was measured among meshes of so many triangles.
inline constexpr double instance_cost_embree = 1, instance_cost_bvh = 2;

/// Bytes that a triangle takes in a Geometry and Embree's scene of it, and an instance in theirs.
inline constexpr std::size_t bytes_per_triangle = 100, bytes_per_instance = 300;

/// Mesh objects of the top level that repeat an earlier one, by object: with the same material, the same triangles and
/// the same order of vertices. With a tolerance of 0 those moved by a translation that no coordinate is rounded by, and
/// with the same normals; above 0 also those that a rotation, a uniform scale and a translation take to within it.
/// Mirror images are none. Time is linear in the mesh but where many differ in shape only: each is compared with the
/// first few. Throws Error when the tolerance is not finite or below 0.
std::vector<Repeat> find_repeats(const Geometry& geometry, double tolerance,
                                 std::uint32_t min_triangles = fewest_repeated_triangles);

}  // namespace rayengine
