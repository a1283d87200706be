#pragma once

#include "cpu/bvh_instances.h"
#include "cpu/reference/candidates.h"

namespace rayengine {

/// What placing a ray in a group's space may be off by: fewer than six roundings a component.
RayError placing_error(const Ray& ray, const WorldToObject& map);

/// Gives `sink` the hits of one valid ray by the oracle's tests, exact as those are, of what the BVH says the ray may
/// meet before `end`, a bound on what the sink wants.
void trace_exactly(const BvhScene& scene, const BvhInstances& instances, Ray ray, double end, reference::Sink& sink);

}  // namespace rayengine
