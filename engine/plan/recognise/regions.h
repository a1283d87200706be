#pragma once

#include <numeric>
#include <span>
#include <vector>

#include "engine/plan/recognise/topology.h"

namespace rayengine::surfaces {

/// A partition of some triangles. Regions are numbered by their lowest triangle.
class Regions {
 public:
  /// `region_of`: of each triangle its region, or no_id where it is in none.
  explicit Regions(std::vector<std::uint32_t> region_of, std::uint32_t count)
      : region_of_(std::move(region_of)), first_(count + 1, 0) {
    for (const std::uint32_t r : region_of_)
      if (r != no_id) ++first_[r + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    triangles_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t t = 0; t < region_of_.size(); ++t)
      if (region_of_[t] != no_id) triangles_[next[region_of_[t]]++] = t;
  }

  std::size_t size() const { return first_.size() - 1; }
  /// Ascending.
  std::span<const std::uint32_t> operator[](std::size_t region) const {
    return std::span(triangles_).subspan(first_[region], first_[region + 1] - first_[region]);
  }
  std::uint32_t of(std::uint32_t triangle) const { return region_of_[triangle]; }

 private:
  std::vector<std::uint32_t> region_of_, first_, triangles_;
};

/// Connected parts of the `among` triangles, joined over those half-edges with twins for which `joins` holds.
template <class Joins>
Regions connected(const Topology& mesh, std::span<const std::uint32_t> among, Joins joins) {
  constexpr std::uint32_t waiting = no_id - 1;
  std::vector<std::uint32_t> region_of(mesh.triangles.size(), no_id), stack;
  for (const std::uint32_t t : among) region_of[t] = waiting;
  std::uint32_t count = 0;
  for (const std::uint32_t seed : among) {
    if (region_of[seed] != waiting) continue;
    region_of[seed] = count;
    stack.push_back(seed);
    while (!stack.empty()) {
      const std::uint32_t t = stack.back();
      stack.pop_back();
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        const std::uint32_t twin = mesh.twins[h];
        if (twin == no_id || region_of[twin / 3] != waiting || !joins(h)) continue;
        region_of[twin / 3] = count;
        stack.push_back(twin / 3);
      }
    }
    ++count;
  }
  return Regions(std::move(region_of), count);
}

}  // namespace rayengine::surfaces
