#pragma once

#include <memory>

#include "accel/geometry.h"
#include "accel/tracer.h"

namespace rayengine {

/// Embree: triangles native, quadrics as user geometry with callbacks on our kernels, single precision traversal.
/// Holds `fast` (all in float) and `robust` (Embree's robust mode; quadrics in double on the rays as given).
std::unique_ptr<Tracer> make_embree_tracer(std::shared_ptr<const Geometry> geometry, Precision precision);

}  // namespace rayengine
