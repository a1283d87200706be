#include "gpu/grid/grid_policy.h"

#include <algorithm>
#include <numeric>

namespace rayengine {
namespace {

GridState most_wanted(const GridCounts& waiting) {
  return static_cast<GridState>(std::max_element(waiting.begin(), waiting.end()) - waiting.begin());
}

}  // namespace

std::optional<GridState> next_kernel(const GridPolicy& policy, const GridCounts& waiting) {
  const auto under_way = static_cast<double>(std::accumulate(waiting.begin(), waiting.end(), std::size_t{0}));
  if (under_way == 0) return std::nullopt;
  if (policy.rule == GridPolicy::Rule::most) return most_wanted(waiting);
  for (const GridState state : {GridState::intersect, GridState::shade}) {
    const std::size_t count = waiting[static_cast<std::size_t>(state)];
    if (count > 0 && static_cast<double>(count) >= policy.share * under_way) return state;
  }
  if (waiting[0] > 0) return GridState::traverse;
  return most_wanted(waiting);
}

}  // namespace rayengine
