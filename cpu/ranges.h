#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <vector>

#include "accel/tracer.h"

namespace rayengine {

/// Calls work(first, last) for ranges that make up [0, count), on all threads; up to a grain, on the calling one.
template <class Work>
void for_ranges(std::size_t count, Work&& work) {
  constexpr std::size_t grain = 2048;
  if (count <= grain) return work(0, count);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, (count + grain - 1) / grain, 1),
                    [&](const auto& range) { work(range.begin() * grain, std::min(range.end() * grain, count)); });
}

inline void sort_hits(std::vector<Hit>& hits) {
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) {
    return std::tie(a.t, a.object, a.primitive) < std::tie(b.t, b.object, b.primitive);
  });
}

/// The lists of hits that `list_of(i)` finds for each of `count` rays, in order.
template <class ListOf>
HitLists all_lists(std::size_t count, ListOf&& list_of) {
  std::vector<std::vector<Hit>> lists(count);
  for_ranges(count, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) lists[i] = list_of(i);
  });
  HitLists result;
  result.offsets.push_back(0);
  for (const auto& list : lists) {
    result.hits.insert(result.hits.end(), list.begin(), list.end());
    result.offsets.push_back(result.hits.size());
  }
  return result;
}

}  // namespace rayengine
