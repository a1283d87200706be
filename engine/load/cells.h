#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <utility>
#include <vector>

namespace rayengine {

/// A partition of the vertices of a mesh.
struct Clusters {
  std::vector<std::uint32_t> of;              // by vertex; no_id where no triangle uses it
  std::vector<std::uint32_t> first, members;  // vertices of cluster c: members[first[c], first[c + 1])
  std::vector<std::uint32_t> representative;  // by cluster
  std::vector<glm::dvec3> normals;            // of all triangles at its vertices, not normalised

  std::span<const std::uint32_t> members_of(std::uint32_t c) const {
    return {members.data() + first[c], members.data() + first[c + 1]};
  }
  std::size_t count() const { return representative.size(); }
};

/// Clusters of the vertices that share a cell of a grid and face the same way. Cells are some limits wide at first;
/// they can be halved one by one, until each vertex in them is alone.
class Cells {
 public:
  /// How often a cell can be halved, the last time into single vertices.
  static constexpr int levels = 4;

  Cells(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles, double limit);

  const Clusters& clusters() const { return clusters_; }

  /// Halves the cells of the clusters that are marked, `times` times, and numbers all clusters anew.
  void split(const std::vector<char>& marked, int times);

 private:
  using Key = std::pair<std::uint64_t, std::uint32_t>;  // of a cell, and a vertex in it

  std::uint64_t cell(std::uint32_t vertex) const;
  void number();
  void represent(std::uint32_t cluster);

  std::span<const glm::dvec3> positions_;
  double limit_;
  std::vector<glm::dvec3> normals_;  // by vertex, not normalised
  std::vector<std::uint8_t> level_;  // by vertex
  std::vector<Key> keys_;            // equal ones side by side
  Clusters clusters_;
};

}  // namespace rayengine
