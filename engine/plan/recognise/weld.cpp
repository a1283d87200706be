#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <numeric>
#include <tuple>

#include "engine/plan/recognise/topology.h"

namespace rayengine::surfaces {

std::vector<glm::uvec3> weld(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles) {
  std::vector<std::uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  tbb::parallel_sort(order, [&](std::uint32_t a, std::uint32_t b) {
    const glm::dvec3 &p = positions[a], &q = positions[b];
    return std::tie(p.x, p.y, p.z, a) < std::tie(q.x, q.y, q.z, b);
  });
  std::vector<std::uint32_t> vertex(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && positions[order[i]] == positions[order[i - 1]];
    vertex[order[i]] = same ? vertex[order[i - 1]] : order[i];
  }
  std::vector<glm::uvec3> result(triangles.size());
  tbb::parallel_for(std::size_t{0}, triangles.size(), [&](std::size_t i) {
    for (int k = 0; k < 3; ++k) result[i][k] = vertex[triangles[i][k]];
  });
  return result;
}

}  // namespace rayengine::surfaces
