#pragma once

#include "engine/measure/stress/stress.h"

namespace rayengine::stability {

/// The limit that a row breaks, in words; empty when none. Where the arithmetic decides, a tracer is held to the
/// round-off that it states of itself.
std::string broken_limit(const StressRow& row, const Case& from, const Limits& limits);

}  // namespace rayengine::stability
