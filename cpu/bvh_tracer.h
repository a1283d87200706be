#pragma once

#include <memory>

#include "accel/geometry.h"
#include "accel/tracer.h"

namespace rayengine {

/// Our own traversal of a BVH built through Embree, and our own tests in double: precision robust. Triangles are
/// watertight, at vertices too, and as exact as quadrics. Throws Error for other precisions.
std::unique_ptr<Tracer> make_bvh_tracer(std::shared_ptr<const Geometry> geometry, Precision precision);

}  // namespace rayengine
