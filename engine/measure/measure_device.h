#pragma once

#include "engine/plan/device.h"
#include "engine/tracers.h"

namespace rayengine {

/// Measures what a plan chooses by: builds each tracer, at each precision and with each structure, over few, some and
/// many triangles, quadrics and instances, and asks it rays of a picture and scattered ones; and recognises and
/// coarsens made meshes. By the threads and the GPU of `where`; what needs a GPU is left out where there is none. Takes
/// half a minute.
DeviceMeasurements measure_device(const TracerOptions& where);

}  // namespace rayengine
