#pragma once

#include "accel/geometry.h"

namespace rayengine {

/// Throws Error unless positions are finite, indices within range, and normals one a position or none.
void check_mesh(const Mesh& mesh);

/// Throws Error unless a tolerance that something is to be kept to is finite and above 0.
void check_tolerance(double tolerance);

/// Both.
void check_mesh(const Mesh& mesh, double tolerance);

}  // namespace rayengine
