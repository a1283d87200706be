#pragma once

#include <cstdint>

#include "accel/geometry.h"

namespace rayengine {

/// What a few patches of a mesh, runs of triangles that follow each other, say of the whole.
struct Patches {
  double area = 0;           ///< mean of a triangle
  double quadric_share = 0;  ///< of the patches, those whose vertices lie on a quadric
  double ball_share = 0;     ///< those that lie on an ellipsoid, and on no other quadric
};

/// Looks at no more than some thousand triangles.
Patches look_at_patches(const Geometry& geometry, std::uint32_t object);

}  // namespace rayengine
