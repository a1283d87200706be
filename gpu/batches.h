#pragma once

#include <functional>
#include <span>

#include "gpu/device_engine.h"

namespace rayengine {

/// Sends all valid rays in batches of at most `size`, and those who look behind their hits again, until every one has
/// arrived; one batch is on the device at a time. `frame_of` takes a ray to the scene's frame, from several threads;
/// `cast` enters the travellers' answers.
void trace_in_batches(std::span<const Ray> rays, std::size_t size, const std::function<FrameRay(const Ray&)>& frame_of,
                      const std::function<void(std::span<Traveller>)>& cast, const DeviceEngine::Arrive& arrive);

}  // namespace rayengine
