#pragma once

#include <memory>

#include "accel/geometry.h"
#include "accel/tracer.h"

namespace rayengine {

/// The oracle: every test in __float128 with textbook formulas, on the inputs as stored. Slow and simple.
std::unique_ptr<Tracer> make_reference_tracer(std::shared_ptr<const Geometry> geometry);

}  // namespace rayengine
