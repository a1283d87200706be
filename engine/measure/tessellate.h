#pragma once

#include <optional>
#include <vector>

#include "accel/geometry.h"

namespace rayengine {

/// A geometry with triangles in place of its quadrics: what is done where there are no exact ones.
struct Tessellation {
  std::shared_ptr<const Geometry> geometry;  ///< the same objects, all meshes
  std::vector<std::uint32_t> parts;          ///< of each triangle: what its quadric's primitive there is, else no_id
};

inline constexpr int tessellation_levels = 5;

/// Level 1 is coarse: 32 triangles a whole sphere, and 8 segments around other bodies. Each level has half the width of
/// the one before: at level 3, 512 triangles a sphere. All vertices lie on the surfaces; planes become squares of 2e4.
/// Nothing where there are no quadrics, or instances, unbounded surfaces or saddles that planes cut, or where more than
/// 8 million triangles would result.
std::optional<Tessellation> tessellate(const Geometry& geometry, int level);

/// The unit sphere: an octahedron, each face cut in four `subdivisions` times.
Mesh subdivided_sphere(int subdivisions);

/// Where x^T Q x = 0 within a finite box, by marching tetrahedra in `cells` cubes a side.
Mesh form_mesh(const GeneralForm& form, int cells);

}  // namespace rayengine
