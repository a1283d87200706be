#pragma once

#include "gpu/points/point_stream.h"
#include "gpu/points/points_caster.h"

namespace rayengine {

/// A point for every pixel, whose ray the vertex shader makes. Throws Error when the picture is too large.
PointStream fresh_rays(RayFormat format, const CastView& view);

}  // namespace rayengine
