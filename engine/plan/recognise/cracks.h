#pragma once

#include "engine/plan/recognise/caps.h"

namespace rayengine::surfaces {

/// Where a curved rim leaves the straight edges of the triangles beside it, rays may slip between the two. Takes back
/// what was found with such a rim, until none is left, and returns its triangles. A rim is closed where the quadric
/// beside it has the same one, and where the triangle beside it lies on under it, as a plate does round a hole.
std::vector<std::uint32_t> take_back_cracked(const Topology& mesh, std::vector<Found>& found, double tolerance);

}  // namespace rayengine::surfaces
