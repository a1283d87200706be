#include "engine/plan/recognise/coincident.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <utility>

namespace rayengine::surfaces {
namespace {

std::uint64_t hash(const glm::dvec3& cell) {
  std::uint64_t h = 0;
  for (int i = 0; i < 3; ++i) {
    h = (h ^ std::bit_cast<std::uint64_t>(cell[i] + 0.0)) * 0x9E3779B97F4A7C15u;
    h ^= h >> 29;
  }
  return h;
}

bool near(const Round& a, const Round& b, double distance) {
  const glm::dvec3 apart = glm::max(glm::abs(a.center - b.center), glm::abs(a.half - b.half));
  return std::max({apart.x, apart.y, apart.z}) <= distance;
}

}  // namespace

// Cells four distances wide, sorted: what is near is in one of the eight cells next to the nearest corner.
std::vector<bool> coincident(std::span<const Round> rounds, double distance) {
  const double per_cell = 0.25 / distance;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> cells;
  for (std::uint32_t i = 0; i < rounds.size(); ++i)
    cells.emplace_back(hash(glm::floor(rounds[i].center * per_cell)), i);
  std::ranges::sort(cells);
  std::vector<bool> result(rounds.size());
  for (std::uint32_t i = 0; i < rounds.size(); ++i) {
    const glm::dvec3 corner = glm::floor(rounds[i].center * per_cell - 0.5);
    for (int k = 0; k < 8 && !result[i]; ++k) {
      const std::uint64_t cell = hash(corner + glm::dvec3(k & 1, k >> 1 & 1, k >> 2));
      for (auto at = std::ranges::lower_bound(cells, std::pair{cell, 0u}); at != cells.end() && at->first == cell; ++at)
        if (at->second != i && near(rounds[i], rounds[at->second], distance)) result[i] = true;
    }
  }
  return result;
}

}  // namespace rayengine::surfaces
