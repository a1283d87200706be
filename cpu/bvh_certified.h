#pragma once

#include <memory>

#include "accel/geometry.h"
#include "accel/tracer.h"

namespace rayengine {

/// The tracer `bvh` at precision `certified`: every t comes with a proven bound (see docs/accuracy.md), ids are those
/// of exact arithmetic, and so is whether anything is hit. Rays that double precision cannot tell are answered by the
/// oracle's tests, and have status_resolved.
std::unique_ptr<Tracer> make_certified_bvh(std::shared_ptr<const Geometry> geometry);

}  // namespace rayengine
