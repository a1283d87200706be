#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <tuple>

#include "engine/plan/recognise/topology.h"

namespace rayengine::surfaces {

std::vector<glm::uvec3> weld(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles,
                             std::span<const std::uint32_t> among) {
  std::vector<std::uint32_t> vertex(positions.size(), no_id), order;
  for (const std::uint32_t t : among)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = triangles[t][k];
      if (vertex[v] == no_id) order.push_back(v);
      vertex[v] = v;
    }
  tbb::parallel_sort(order, [&](std::uint32_t a, std::uint32_t b) {
    const glm::dvec3 &p = positions[a], &q = positions[b];
    return std::tie(p.x, p.y, p.z, a) < std::tie(q.x, q.y, q.z, b);
  });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (positions[order[i]] == positions[order[i - 1]]) vertex[order[i]] = vertex[order[i - 1]];
  std::vector<glm::uvec3> result(triangles.begin(), triangles.end());
  tbb::parallel_for(std::size_t{0}, among.size(), [&](std::size_t i) {
    for (int k = 0; k < 3; ++k) result[among[i]][k] = vertex[triangles[among[i]][k]];
  });
  return result;
}

}  // namespace rayengine::surfaces
