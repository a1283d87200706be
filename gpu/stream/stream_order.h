#pragma once

#include <cstdint>
#include <vector>

namespace rayengine {

/// What to sort by, and the place of what is sorted.
struct SortKey {
  std::uint64_t key;
  std::uint32_t index;
};

/// Sorts by the lowest `bits` of the keys, keeping the order of equals; `spare` is room to work in. A radix sort: for
/// batches of rays it takes a tenth of what sorting by comparison does.
void radix_sort(std::vector<SortKey>& keys, std::vector<SortKey>& spare, unsigned bits);

}  // namespace rayengine
