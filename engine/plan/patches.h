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

/// Looks at so many patches, of 48 triangles each; at one at least, and at no more than there are.
Patches look_at_patches(const Geometry& geometry, std::uint32_t object, std::uint32_t patches);

}  // namespace rayengine
