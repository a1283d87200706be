#pragma once

#include "engine/plan/recognise/regions.h"

namespace rayengine::surfaces {

/// Parts of cylinders among triangles that wait, where they run smoothly into something else: each is grown from a few
/// triangles whose corners lie on a cylinder, over all that are on it too.
Regions grow_cylinders(const Topology& mesh, std::span<const std::uint32_t> waiting);

}  // namespace rayengine::surfaces
