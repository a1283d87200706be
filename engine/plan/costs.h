#pragma once

#include "engine/plan/plan.h"

// What both halves of a plan reckon with; not for callers.
namespace rayengine {

// Of the tolerance: what arithmetic may use, and what stands in for a mesh, which leaves arithmetic the rest.
inline constexpr double arithmetic_share = 0.1, model_share = 0.97;
// Another way than the usual one must be predicted to take no more than this of its time: predictions are rough.
inline constexpr double worthwhile = 0.85;

/// What is done without a plan: embree at robust.
const TracerCost& usual_tracer(const DeviceMeasurements& device);

}  // namespace rayengine
