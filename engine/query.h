#pragma once

#include <functional>
#include <span>

#include "accel/tracer.h"

// Queries of many rays: cut into batches of the size that the tracer likes, and asked from several threads where it
// allows that. Answers are those of one call of the tracer.
namespace rayengine {

/// Called now and then, from any thread, with the number of rays answered since the last call.
using RaysDone = std::function<void(std::size_t rays)>;

void closest(Tracer& tracer, std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class,
             const RaysDone& done = {});

/// `status` gets status_hit, status_miss or status_invalid for each ray.
void any(Tracer& tracer, std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class,
         const RaysDone& done = {});

HitLists all(Tracer& tracer, std::span<const Ray> rays, const RaysDone& done = {});

}  // namespace rayengine
