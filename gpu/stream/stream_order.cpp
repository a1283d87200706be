#include "gpu/stream/stream_order.h"

#include <array>
#include <numeric>

namespace rayengine {
namespace {

constexpr unsigned digit_bits = 11;
constexpr std::size_t digits = std::size_t{1} << digit_bits;

std::size_t digit(const SortKey& k, unsigned shift) { return k.key >> shift & (digits - 1); }

void sort_by_digit(const std::vector<SortKey>& from, std::vector<SortKey>& to, unsigned shift) {
  std::array<std::size_t, digits> first{};
  for (const SortKey& k : from) ++first[digit(k, shift)];
  std::exclusive_scan(first.begin(), first.end(), first.begin(), std::size_t{0});
  for (const SortKey& k : from) to[first[digit(k, shift)]++] = k;
}

}  // namespace

void radix_sort(std::vector<SortKey>& keys, std::vector<SortKey>& spare, unsigned bits) {
  spare.resize(keys.size());
  for (unsigned shift = 0; shift < bits; shift += digit_bits) {
    sort_by_digit(keys, spare, shift);
    keys.swap(spare);
  }
}

}  // namespace rayengine
