#pragma once

#include "accel/geometry.h"
#include "accel/tracer.h"

namespace rayengine {

/// How far, in world space, rounding in a tracer's arithmetic can be thought to move a ray where it passes the
/// primitive of `hit`, at any t up to `t`. The sizes of all coordinates that meet on the way (the ray's, the maps' to
/// object space and back, the triangle's corners) are added up and multiplied by `rounding_units` of the tracer's
/// round-off; slender triangles lose more, in proportion to their longest edge over their height.
double rounding_bound(const Geometry& geometry, const Limits& limits, const Ray& ray, const Hit& hit);

/// Roundings on the way from a ray to an answer: 3 for each of two maps, 2 for corners as seen from the ray, 4 for an
/// edge function or a coefficient, 4 for the root or quotient.
inline constexpr double rounding_units = 16;

}  // namespace rayengine
