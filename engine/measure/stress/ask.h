#pragma once

#include "engine/measure/compare.h"
#include "engine/measure/stress/case.h"

// What a tracer answers to a case, whatever the query, in a form that can be compared ray by ray.
namespace rayengine::stability {

struct Asked {
  std::vector<Hit> hits;               ///< one a ray, or all of every ray where the query is for all
  std::vector<std::uint64_t> offsets;  ///< of the rays in `hits`, where the query is for all
};

/// Answers that are never written are found as NaN.
Asked ask(Tracer& tracer, const Case& one);

Comparison judge(const Case& one, const Limits& limits, const Asked& asked, const Asked& exact, Tracer* oracle);

}  // namespace rayengine::stability
