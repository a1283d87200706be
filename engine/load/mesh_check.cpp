#include "engine/load/mesh_check.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <vector>

namespace rayengine {
namespace {

std::array<std::uint32_t, 3> sorted(const glm::uvec3& t) {
  std::array<std::uint32_t, 3> corners{t.x, t.y, t.z};
  std::ranges::sort(corners);
  return corners;
}

std::uint64_t edge(std::uint32_t a, std::uint32_t b) { return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b); }

void count_edges(std::span<const glm::uvec3> triangles, MeshDefects& defects) {
  std::vector<std::uint64_t> edges;
  edges.reserve(3 * triangles.size());
  for (const glm::uvec3& t : triangles)
    for (int k = 0; k < 3; ++k) edges.push_back(edge(t[k], t[(k + 1) % 3]));
  std::ranges::sort(edges);
  for (auto first = edges.begin(); first != edges.end();) {
    const auto last = std::find_if(first, edges.end(), [&](std::uint64_t e) { return e != *first; });
    defects.boundary_edges += last - first == 1;
    defects.non_manifold_edges += last - first > 2;
    first = last;
  }
}

std::uint64_t count_duplicates(std::span<const glm::uvec3> triangles) {
  std::vector<std::array<std::uint32_t, 3>> corners;
  corners.reserve(triangles.size());
  for (const glm::uvec3& t : triangles) corners.push_back(sorted(t));
  std::ranges::sort(corners);
  const auto last = std::unique(corners.begin(), corners.end());  // std::ranges::unique is beyond clang 14
  return static_cast<std::uint64_t>(corners.end() - last);
}

bool has_area(std::span<const glm::dvec3> p, const glm::uvec3& t) {
  return glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x]) != glm::dvec3(0);
}

}  // namespace

MeshDefects find_defects(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles) {
  MeshDefects defects;
  for (const glm::uvec3& t : triangles) defects.without_area += !has_area(positions, t);
  defects.duplicates = count_duplicates(triangles);
  count_edges(triangles, defects);
  return defects;
}

std::string to_string(const MeshDefects& defects) {
  std::string text;
  const auto add = [&](std::uint64_t count, const char* what) {
    if (count) text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + what;
  };
  add(defects.without_area, "triangles of no area");
  add(defects.duplicates, "duplicate triangles");
  add(defects.boundary_edges, "boundary edges");
  add(defects.non_manifold_edges, "non-manifold edges");
  return text;
}

}  // namespace rayengine
