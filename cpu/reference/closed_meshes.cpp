#include "cpu/reference/closed_meshes.h"

#include <algorithm>

namespace rayengine::reference {
namespace {

constexpr std::uint64_t edge(std::uint32_t from, std::uint32_t to) {
  return static_cast<std::uint64_t>(from) << 32 | to;
}
constexpr std::uint64_t turned_round(std::uint64_t e) { return e << 32 | e >> 32; }

/// By directed edges, sorted.
bool is_closed(std::vector<std::uint64_t>& edges) {
  std::sort(edges.begin(), edges.end());
  const bool unique = std::adjacent_find(edges.begin(), edges.end()) == edges.end();
  return unique && std::all_of(edges.begin(), edges.end(), [&](std::uint64_t e) {
           return std::binary_search(edges.begin(), edges.end(), turned_round(e));
         });
}

std::vector<bool> closed_objects(const Geometry& geometry) {
  std::vector<std::vector<std::uint64_t>> edges(geometry.objects.size());
  for (std::size_t i = 0; i < geometry.triangles.size(); ++i) {
    const glm::uvec3& t = geometry.triangles[i];
    for (int k = 0; k < 3; ++k) edges[geometry.triangle_object[i]].push_back(edge(t[k], t[(k + 1) % 3]));
  }
  std::vector<bool> closed;
  for (auto& of_object : edges) closed.push_back(!of_object.empty() && is_closed(of_object));
  return closed;
}

}  // namespace

void ClosedMeshes::look() const {
  closed_[&geometry_] = closed_objects(geometry_);
  for (const auto& group : geometry_.groups) closed_[group.get()] = closed_objects(*group);
}

bool ClosedMeshes::contains(const Geometry& holder, std::uint32_t object) const {
  std::call_once(looked_, [this] { look(); });
  return closed_.at(&holder)[object];
}

}  // namespace rayengine::reference
