#pragma once

#include <span>
#include <vector>

#include "accel/transform.h"

namespace rayengine::surfaces {

/// Of each ellipsoid, the image of the unit sphere, whether there is another with its centre and lengths of axes within
/// `distance` of it and within a small share of its size.
std::vector<bool> doubled(std::span<const Affine> ellipsoids, double distance);

}  // namespace rayengine::surfaces
