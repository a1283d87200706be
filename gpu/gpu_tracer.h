#pragma once

#include <functional>
#include <memory>
#include <string_view>

#include "accel/geometry.h"
#include "accel/tracer.h"
#include "gpu/device_engine.h"

namespace rayengine {

/// Called on the thread that will own the engine and its context.
using MakeEngine = std::function<std::unique_ptr<DeviceEngine>()>;

/// A tracer over a device: queries from any thread, one at a time, are served by a thread that owns the OpenGL context.
/// `robust` works each hit that the device found out in double, and has the ray look behind those that prove to be
/// none; `fast` and `half` take t as it comes. `name` must outlive the tracer.
std::unique_ptr<Tracer> make_gpu_tracer(std::string_view name, std::shared_ptr<const Geometry> geometry,
                                        Precision precision, const MakeEngine& make);

}  // namespace rayengine
