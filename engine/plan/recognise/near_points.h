#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <utility>
#include <vector>

namespace rayengine::surfaces {

/// Finds points near others: cells four distances wide, sorted by their hash.
class NearPoints {
 public:
  NearPoints(std::span<const glm::dvec3> points, double distance) : per_cell_(0.25 / distance) {
    for (std::uint32_t i = 0; i < points.size(); ++i) cells_.emplace_back(hash(glm::floor(points[i] * per_cell_)), i);
    std::ranges::sort(cells_);
  }

  /// Calls visit(index) for all points within the distance of p, and some others.
  template <class Visit>
  void each(const glm::dvec3& p, Visit visit) const {
    const glm::dvec3 corner = glm::floor(p * per_cell_ - 0.5);  // what is near is in the eight cells about it
    for (int k = 0; k < 8; ++k) {
      const std::uint64_t cell = hash(corner + glm::dvec3(k & 1, k >> 1 & 1, k >> 2));
      auto at = std::ranges::lower_bound(cells_, std::pair{cell, 0u});
      for (; at != cells_.end() && at->first == cell; ++at) visit(at->second);
    }
  }

 private:
  static std::uint64_t hash(const glm::dvec3& cell) {
    std::uint64_t h = 0;
    for (int i = 0; i < 3; ++i) {
      h = (h ^ std::bit_cast<std::uint64_t>(cell[i] + 0.0)) * 0x9E3779B97F4A7C15u;
      h ^= h >> 29;
    }
    return h;
  }

  double per_cell_;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> cells_;
};

}  // namespace rayengine::surfaces
