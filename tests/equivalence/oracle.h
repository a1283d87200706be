#pragma once

#include <memory>

#include "accel/geometry.h"
#include "accel/tracer.h"

namespace rayengine::test {

/// The oracle on a geometry. It remembers its answers: all tracers are held against it on the same rays, and it is
/// slow.
Tracer& oracle_on(const std::shared_ptr<const Geometry>& geometry);

}  // namespace rayengine::test
