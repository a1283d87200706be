#pragma once

#include <memory>

#include "accel/geometry.h"
#include "accel/tracer.h"

namespace rayengine {

/// Our own traversal of a BVH built through Embree, and our own tests in double: precision robust. Triangles are
/// watertight, at vertices too, and as exact as quadrics. Throws Error for other precisions.
std::unique_ptr<Tracer> make_bvh_tracer(std::shared_ptr<const Geometry> geometry, Precision precision);

/// The same tests without a structure: every ray is tested against every primitive (but groups that instances place
/// keep theirs). What structures, and devices without any, are measured against. Precision robust.
std::unique_ptr<Tracer> make_loop_tracer(std::shared_ptr<const Geometry> geometry);

}  // namespace rayengine
