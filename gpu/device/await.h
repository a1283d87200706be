#pragma once

#include "gpu/device/context.h"
#include "gpu/device/objects.h"

namespace rayengine {

/// Waits for a batch's last command, and makes sure that its answers can be believed: once a device is lost, fences
/// count as reached whatever was done. Throws Error when the device failed, or has not answered for a minute.
void await(const Fence& fence, Context& context);

}  // namespace rayengine
