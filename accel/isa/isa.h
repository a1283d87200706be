#pragma once

#include <string_view>

namespace rayengine {

/// Instruction sets for which the hot loops are built; one binary holds them all.
enum class Isa { sse2, avx2, avx512 };

std::string_view to_string(Isa isa);

/// The best that this processor has; the environment variable RAYENGINE_ISA may name a lower one.
Isa best_isa();

}  // namespace rayengine
