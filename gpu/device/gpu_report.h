#pragma once

#include "gpu/device/context.h"
#include "gpu/device/probe.h"

namespace rayengine {

/// What `info` says of a device: who it is, what its arithmetic does, and what its shaders cost.
struct GpuReport {
  GpuInfo info;
  GpuProbe probe;
  double compile_seconds = 0;  ///< until the shaders for all types of primitives have been compiled and drawn with
  bool cached = false;         ///< they came from the cache of an earlier run
};

/// Opens the device (by its number; the best when negative), probes it and compiles. Throws Error when it cannot be
/// used.
GpuReport report_on_gpu(int device = -1);

}  // namespace rayengine
