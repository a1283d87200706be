#pragma once

#include "engine/plan/device.h"

namespace rayengine::test {

/// A machine on which triangles cost so much that all are replaced that can be.
inline DeviceMeasurements eager_device() {
  DeviceMeasurements device = usual_device();
  device.recognise_parts = 0;
  for (TracerCost& cost : device.tracers) cost.triangle.build *= 1e6;
  return device;
}

}  // namespace rayengine::test
