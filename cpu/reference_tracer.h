#pragma once

#include <memory>

#include "accel/geometry.h"
#include "accel/tracer.h"

namespace rayengine {

/// The oracle: every test in __float128 with textbook formulas, on the inputs as stored, and exactly where those cannot
/// tell. Slow and simple. All hits of closed meshes and capped quadrics are where the ray passes between inside and
/// outside: one at an edge, a vertex or a rim that is crossed, an even number or none where one is touched.
std::unique_ptr<Tracer> make_reference_tracer(std::shared_ptr<const Geometry> geometry);

}  // namespace rayengine
