#pragma once

#include "cpu/bvh_instances.h"
#include "cpu/reference/candidates.h"

namespace rayengine {

/// Gives `sink` the hits of one ray by the oracle's tests, exact as those are, of what the BVH says the ray may meet.
void trace_exactly(const BvhScene& scene, const BvhInstances& instances, const Ray& ray, reference::Sink& sink);

}  // namespace rayengine
