#pragma once

#include <cstdint>
#include <span>

#include "accel/ray.h"
#include "accel/treelets.h"

namespace rayengine {

/// A treelet on a ray's way.
struct TreeletEntry {
  double t = 0;  ///< where the ray enters it, in units of its direction; never above the exact t of a hit within, nor
                 ///< below tmin
  std::uint32_t treelet = 0;
};

/// Where the walk of a ray has come to; a fresh one stands at the ray's start.
struct WalkCursor {
  std::uint64_t last = 0;

  static constexpr std::uint64_t end = ~std::uint64_t{0};
  bool finished() const { return last == end; }
};

/// Lists, for each ray, the next treelets (at most `capacity`) that it meets in [tmin, tmax], by ascending t, then by
/// treelet. The list of ray i is lists[i * capacity] and on, counts[i] entries long; its cursor moves behind them, and
/// is finished when there are no more. To go on, call again with the cursor and the same origin, direction and tmin;
/// tmax may have been lowered. No treelet that a ray meets is left out, whatever rounding does. Invalid rays meet none.
/// Spans must hold rays.size() entries, `lists` capacity times as many; `capacity` is at least 1. Safe to call from
/// several threads.
void walk(const Treelets& treelets, std::span<const Ray> rays, std::span<WalkCursor> cursors, std::uint32_t capacity,
          std::span<TreeletEntry> lists, std::span<std::uint32_t> counts);

}  // namespace rayengine
