#include "accel/isa/isa.h"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace rayengine {
namespace {

constexpr std::array<std::string_view, 3> names{"sse2", "avx2", "avx512"};

Isa processor_isa() {
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi");
  const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
  if (!avx2) return Isa::sse2;
  return avx512 ? Isa::avx512 : Isa::avx2;
}

}  // namespace

std::string_view to_string(Isa isa) { return names[static_cast<std::size_t>(isa)]; }

Isa best_isa() {
  static const Isa chosen = [] {
    const Isa processor = processor_isa();
    const char* wish = std::getenv("RAYENGINE_ISA");
    const auto found = std::find(names.begin(), names.end(), wish ? wish : "");
    return found == names.end() ? processor : std::min(processor, static_cast<Isa>(found - names.begin()));
  }();
  return chosen;
}

}  // namespace rayengine
