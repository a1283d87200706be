#pragma once

#include <string>
#include <utility>
#include <vector>

namespace rayengine {

class Context;

/// What the arithmetic of one shader stage was seen to do, over a few thousand operands.
struct ArithmeticProbe {
  std::string stage;           ///< "fragment" or "compute"
  bool contracts = false;      ///< a * b + c may lose its first rounding where `precise` is not said
  bool precise_holds = false;  ///< with `precise` it never does: what our kernels rest on
  bool fma_fused = false;      ///< fma() always rounds once
  bool two_sum_exact = false;
  bool dekker_exact = false;
  bool denormals_kept = false;
  double division_ulps = 0;  ///< largest error; up to 0.5 is correct rounding
  double sqrt_ulps = 0;
};

struct GpuProbe {
  std::vector<ArithmeticProbe> stages;
  bool early_depth_test = false;  ///< an EQUAL test that fails keeps the shader from running
  bool query_counts = false;      ///< occlusion queries count what an early test let through, and nothing else

  /// What `stream` needs and the device refuses, in words; empty when it can run there.
  std::vector<std::string> refusals() const;
};

/// Runs the probe on the current context.
GpuProbe probe(Context& context);

/// Asks only for what tracing rests on. Throws Error, with the refusals, when the device cannot be trusted with it.
void require_usable(Context& context);

/// What `info` says: a subject ("fragment", "compute", "early_depth_test", "refused") and the facts about it.
std::vector<std::pair<std::string, std::string>> describe(const GpuProbe& probe);

}  // namespace rayengine
