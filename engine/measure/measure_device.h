#pragma once

#include "engine/plan/device.h"

namespace rayengine {

/// Measures what a plan chooses by: builds each tracer of the processor, at each precision, over few and many balls and
/// triangles, and asks it neighbouring and scattered rays; and recognises and coarsens made meshes. Takes some seconds.
DeviceMeasurements measure_device(int threads);

}  // namespace rayengine
