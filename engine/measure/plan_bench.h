#pragma once

#include <functional>

#include "engine/plan/planned.h"

namespace rayengine {

/// What a picture took: medians, in seconds.
struct PictureCost {
  double planning = 0, build = 0, render = 0;
  std::size_t bytes = 0;  ///< geometry and tracer

  double seconds() const { return planning + build + render; }
};

struct PlanBench {
  PictureCost without, with;
  std::size_t replaced = 0;  ///< objects
};

/// Renders a scene as `auto` does at `robust`, and as a plan has it, planning included, in turns.
PlanBench bench_plan(const Scene& scene, const PlanOptions& options, int threads,
                     const std::function<void(double share)>& progress);

}  // namespace rayengine
