#pragma once

#include <vector>

#include "cpu/bvh_hit.h"
#include "cpu/bvh_instances.h"
#include "cpu/reference/candidates.h"

namespace rayengine {

/// What placing a ray in a group's space may be off by: fewer than six roundings a component.
RayError placing_error(const Ray& ray, const WorldToObject& map);

/// Gives `sink` the hits of one valid ray by the oracle's tests, exact as those are, of what the BVH says the ray may
/// meet before `end`, a bound on what the sink wants. What of that is known in double, with bounds.
std::vector<BvhFound> trace_exactly(const BvhScene& scene, const BvhInstances& instances, Ray ray, double end,
                                    reference::Sink& sink);

}  // namespace rayengine
