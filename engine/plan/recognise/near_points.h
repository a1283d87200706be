#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <utility>
#include <vector>

namespace rayengine::surfaces {

/// Finds things of about the same size in about the same place: by the power of two of their size, then by cells a
/// quarter as wide, sorted by their hash.
class NearPoints {
 public:
  void add(std::uint32_t index, const glm::dvec3& point, double size) {
    const int c = size_class(size);
    cells_[c].emplace_back(hash(glm::floor(point / width(c))), index);
  }
  /// Between the last add() and the first each().
  void sort() {
    for (auto& [c, cells] : cells_) std::ranges::sort(cells);
  }

  /// Calls visit(index) for all whose size is at most twice as large or small, and whose distance is at most 1/16 of
  /// it; and for some others.
  template <class Visit>
  void each(const glm::dvec3& point, double size, Visit visit) const {
    for (int c = size_class(size) - 1; c <= size_class(size) + 1; ++c) {
      const auto found = cells_.find(c);
      if (found == cells_.end()) continue;
      const glm::dvec3 corner = glm::floor(point / width(c) - 0.5);  // what is near is in the eight cells about it
      for (int k = 0; k < 8; ++k) each_in(found->second, hash(corner + glm::dvec3(k & 1, k >> 1 & 1, k >> 2)), visit);
    }
  }

 private:
  using Cells = std::vector<std::pair<std::uint64_t, std::uint32_t>>;

  static int size_class(double size) { return std::ilogb(size); }
  /// At least twice a sixteenth of the largest size that looks in this class: one of the class above.
  static double width(int size_class) { return std::ldexp(1., size_class - 1); }

  template <class Visit>
  static void each_in(const Cells& cells, std::uint64_t cell, Visit visit) {
    auto at = std::ranges::lower_bound(cells, std::pair{cell, 0u});
    for (; at != cells.end() && at->first == cell; ++at) visit(at->second);
  }

  static std::uint64_t hash(const glm::dvec3& cell) {
    std::uint64_t h = 0;
    for (int i = 0; i < 3; ++i) {
      h = (h ^ std::bit_cast<std::uint64_t>(cell[i] + 0.0)) * 0x9E3779B97F4A7C15u;
      h ^= h >> 29;
    }
    return h;
  }

  std::map<int, Cells> cells_;
};

}  // namespace rayengine::surfaces
