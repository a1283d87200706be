#pragma once

#include <functional>

#include "accel/geometry.h"
#include "engine/plan/device.h"

namespace rayengine {

/// Measures what a plan chooses by: builds each tracer of the processor, at each precision, over few and many balls and
/// triangles, and asks it neighbouring and scattered rays; and has made meshes recognised, and made coarser by
/// `simplify` to a distance. Takes some seconds.
DeviceMeasurements measure_device(int threads, const std::function<void(const Mesh&, double distance)>& simplify);

}  // namespace rayengine
