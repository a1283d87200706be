#pragma once

#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace rayengine {

/// The triangles at each vertex, or at each cluster.
class Incidence {
 public:
  Incidence() = default;
  template <class T, class CornersOf>
  Incidence(std::size_t count, std::span<const T> triangles, CornersOf corners_of)
      : first_(count + 1), list_(3 * triangles.size()) {
    for (const T& t : triangles)
      for (int i = 0; i < 3; ++i) ++first_[corners_of(t)[i] + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<std::uint32_t> next = first_;
    for (std::uint32_t k = 0; k < triangles.size(); ++k)
      for (int i = 0; i < 3; ++i) list_[next[corners_of(triangles[k])[i]]++] = k;
  }
  std::span<const std::uint32_t> operator[](std::uint32_t i) const {
    return {list_.data() + first_[i], list_.data() + first_[i + 1]};
  }

 private:
  std::vector<std::uint32_t> first_, list_;
};

}  // namespace rayengine
