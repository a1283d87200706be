#include "engine/schedule/split.h"

#include <algorithm>
#include <limits>

namespace rayengine {

Split best_split(const RayCosts& c) {
  const double alone = c.threads / c.full;
  if (c.walk >= c.full) return {0, alone};
  const double most = c.walk > 0 ? c.threads / c.walk : std::numeric_limits<double>::infinity();
  const double gpu = std::min(1 / c.gpu, most);
  return {gpu, std::max(0.0, (c.threads - gpu * c.walk) / c.full)};
}

double break_even(const RayCosts& c, double latency) {
  const double saved = c.full - c.walk;
  return saved > 0 ? latency / saved : std::numeric_limits<double>::infinity();
}

}  // namespace rayengine
