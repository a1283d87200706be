#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace rayengine {

/// What a ray of the grid tracer waits for; the number of a state that gpu/shaders/grid/traverse.glsl gives it.
enum class GridState : std::uint32_t { traverse, intersect, shade };
inline constexpr std::size_t grid_state_count = 3;

/// Rays in each state.
using GridCounts = std::array<std::size_t, grid_state_count>;

/// Which kernel runs next. A pass costs something for every ray of the batch, whether it is in that state or not, so a
/// kernel should wait until many want it; but those who wait for another kernel wait longer.
struct GridPolicy {
  enum class Rule {
    turns,  ///< one kernel after the other; spares the counting
    share,  ///< rays traverse until a share of those under way waits for another kernel, which then has its turn
    most,   ///< the kernel that most rays wait for
  };
  Rule rule = Rule::turns;
  double share = 0.5;          ///< of the rays under way; 0: as soon as any wait, 1: when all do
  std::uint32_t steps = 1024;  ///< voxels that a ray crosses in one traverse pass, at most
  double few = 0;  ///< share of a batch that a loop in one shader ends sooner than passes do; of turns. 1: no passes
};

/// Nothing when no ray waits for anything. Not for turns.
std::optional<GridState> next_kernel(const GridPolicy& policy, const GridCounts& waiting);

}  // namespace rayengine
