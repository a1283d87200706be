#pragma once

#include "engine/hybrid/hybrid_tracer.h"
#include "engine/hybrid/ray_pool.h"

namespace rayengine {

/// What a pool measured and decided. `alone_rays` were answered before there was a pool.
HybridReport report_on(const RayPool& pool, std::size_t threads, std::uint64_t alone_rays);

}  // namespace rayengine
