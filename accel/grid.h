#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "accel/treelets.h"

namespace rayengine {

struct GridOptions {
  double density = 2;                               ///< voxels a primitive, about
  std::uint32_t most_along_axis = 1024;             ///< voxels, at most
  std::size_t most_members = std::size_t{1} << 26;  ///< entries in all lists together
};

/// A uniform grid over the triangles and quadrics that a geometry itself holds (not its instances). Every voxel lists
/// what can be hit in it, or within `grid_margin` of it. Immutable once built. Rays go through it by
/// accel/kernels/grid.glsl.
struct Grid {
  glm::vec3 lower{0}, cell{1};        ///< of its frame, `lists.frame`
  glm::uvec3 counts{1};               ///< voxels along each axis; one where the scene is flat
  std::vector<std::uint32_t> voxels;  ///< x running fastest: an index into lists.treelets, or no_id where it is empty
  Treelets lists;                     ///< one a voxel that is not empty; nothing above them. A primitive is in several.

  std::size_t bytes() const { return lists.bytes() + voxels.capacity() * sizeof(std::uint32_t); }
  std::size_t members() const { return lists.triangles.size() + lists.quadrics.size(); }
};

/// How much wider than a voxel its list is, in the frame: many times what single precision can be wrong on the way
/// there.
inline constexpr double grid_margin = 0x1p-17;

/// Voxels along each axis: near cubes, about `density` of them for each of `primitives` in a box of this size; one
/// along axes in which the box is thinner than such a cube.
glm::uvec3 grid_counts(const glm::dvec3& size, std::size_t primitives, const GridOptions& options = {});

/// Throws Error, with the number and the limit, when the lists would be too long.
Grid build_grid(const Geometry& geometry, const GridOptions& options = {});

}  // namespace rayengine
