#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <numeric>

#include "engine/plan/recognise/topology.h"

namespace rayengine::surfaces {
namespace {

using Range = tbb::blocked_range<std::size_t>;
constexpr std::size_t grain = 4096;

/// An edge at its lower vertex: its other one, then the half-edge, in the order that makes pairs neighbours.
using EdgeEnd = std::uint64_t;

class EdgeTable {
 public:
  EdgeTable(std::span<const glm::uvec3> triangles, std::span<const std::uint32_t> among, std::size_t vertices)
      : triangles_(triangles), among_(among), first_(vertices + 1, 0) {
    each_edge([&](std::uint32_t low, EdgeEnd) { ++std::atomic_ref(first_[low + 1]); });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    ends_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    each_edge([&](std::uint32_t low, EdgeEnd end) { ends_[std::atomic_ref(next[low])++] = end; });
  }

  std::vector<std::uint32_t> twins() {
    std::vector<std::uint32_t> twins(3 * triangles_.size(), no_id);
    tbb::parallel_for(Range(0, first_.size() - 1, grain), [&](const Range& range) {
      for (std::size_t v = range.begin(); v != range.end(); ++v) pair(static_cast<std::uint32_t>(v), twins);
    });
    return twins;
  }

 private:
  template <class Visit>
  void each_edge(Visit visit) const {
    tbb::parallel_for(Range(0, among_.size(), grain), [&](const Range& range) {
      for (std::size_t i = range.begin(); i != range.end(); ++i)
        for (std::uint32_t k = 0; k < 3; ++k) {
          const glm::uvec3& t = triangles_[among_[i]];
          const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
          if (low != high) visit(low, EdgeEnd{high} << 32 | (3 * among_[i] + k));
        }
    });
  }

  bool runs_up(std::uint32_t half_edge, std::uint32_t low) const {
    return triangles_[half_edge / 3][half_edge % 3] == low;
  }

  void pair(std::uint32_t low, std::vector<std::uint32_t>& twins) {
    const auto begin = ends_.begin() + first_[low], end = ends_.begin() + first_[low + 1];
    std::sort(begin, end);
    for (auto run = begin; run != end;) {
      const auto next = std::find_if(run, end, [&](EdgeEnd e) { return e >> 32 != *run >> 32; });
      const auto a = static_cast<std::uint32_t>(*run), b = static_cast<std::uint32_t>(*(next - 1));
      if (next - run == 2 && runs_up(a, low) != runs_up(b, low)) twins[a] = b, twins[b] = a;
      run = next;
    }
  }

  std::span<const glm::uvec3> triangles_;
  std::span<const std::uint32_t> among_;
  std::vector<std::uint32_t> first_;  // of each vertex, in `ends_`
  std::vector<EdgeEnd> ends_;
};

}  // namespace

std::vector<std::uint32_t> find_twins(std::span<const glm::uvec3> triangles, std::span<const std::uint32_t> among,
                                      std::size_t vertices) {
  return EdgeTable(triangles, among, vertices).twins();
}

}  // namespace rayengine::surfaces
