#pragma once

#include "accel/geometry.h"

namespace rayengine {

/// Throws Error unless positions are finite, indices within range, and normals one a position or none.
void check_mesh(const Mesh& mesh);

}  // namespace rayengine
