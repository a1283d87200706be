#include "engine/load/cells.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "accel/ray.h"
#include "engine/load/surface_distance.h"

namespace rayengine {
namespace {

constexpr double widest = 4;                                 // cells of level 0, in limits; each level halves them
constexpr std::uint8_t alone = Cells::levels, unused = 255;  // levels of vertices without cells

/// The axis that a normal is nearest to, and its sign: 0 to 5. It keeps the sides of a sheet apart.
std::uint64_t facing(const glm::dvec3& n) {
  const glm::dvec3 size = glm::abs(n);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return static_cast<std::uint64_t>(2 * axis + (n[axis] < 0));
}

std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
  return hash ^ hash >> 32;
}

}  // namespace

Cells::Cells(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles, double limit)
    : positions_(positions),
      limit_(limit),
      normals_(positions.size(), glm::dvec3(0)),
      level_(positions.size(), unused) {
  for (const glm::uvec3& t : triangles)
    for (int k = 0; k < 3; ++k) {
      normals_[t[k]] += area_vector(corners(positions_, t));
      level_[t[k]] = 0;
    }
  for (std::uint32_t v = 0; v < positions_.size(); ++v)
    if (level_[v] != unused) keys_.push_back({0, v});
  tbb::parallel_for(std::size_t{0}, keys_.size(), [&](std::size_t i) { keys_[i].first = cell(keys_[i].second); });
  tbb::parallel_sort(keys_);
  number();
}

// Cells whose hashes are equal by chance become one cluster, which the proof then rejects.
std::uint64_t Cells::cell(std::uint32_t v) const {
  if (level_[v] == alone) return mixed(mixed(alone, v), 0);
  const double side = std::ldexp(widest * limit_, -level_[v]);
  std::uint64_t hash = 8 * level_[v] + facing(normals_[v]);
  for (int k = 0; k < 3; ++k)
    hash = mixed(hash, static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(positions_[v][k] / side))));
  return hash;
}

// Makes clusters of equal keys.
void Cells::number() {
  clusters_ = {std::vector<std::uint32_t>(positions_.size(), no_id), {}, {}, {}, {}};
  clusters_.members.reserve(keys_.size());
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    if (i == 0 || keys_[i].first != keys_[i - 1].first) clusters_.first.push_back(static_cast<std::uint32_t>(i));
    clusters_.of[keys_[i].second] = static_cast<std::uint32_t>(clusters_.first.size() - 1);
    clusters_.members.push_back(keys_[i].second);
  }
  clusters_.representative.resize(clusters_.first.size());
  clusters_.normals.resize(clusters_.first.size());
  clusters_.first.push_back(static_cast<std::uint32_t>(keys_.size()));
  tbb::parallel_for(std::size_t{0}, clusters_.count(),
                    [&](std::size_t c) { represent(static_cast<std::uint32_t>(c)); });
}

// By the vertex that is nearest to the mean, so that no vertex is moved off the surface.
void Cells::represent(std::uint32_t c) {
  const auto members = clusters_.members_of(c);
  glm::dvec3 mean(0), normal(0);
  for (const std::uint32_t v : members)
    mean += positions_[v] / static_cast<double>(members.size()), normal += normals_[v];
  clusters_.normals[c] = normal;
  double least = infinity;
  for (const std::uint32_t v : members)
    if (const glm::dvec3 d = positions_[v] - mean; glm::dot(d, d) < least)
      least = glm::dot(d, d), clusters_.representative[c] = v;
}

// Cells lie within those that they are halves of, so that a cluster is split without a look at the others.
void Cells::split(const std::vector<char>& marked, int times) {
  tbb::parallel_for(std::uint32_t{0}, static_cast<std::uint32_t>(clusters_.count()), [&](std::uint32_t c) {
    if (!marked[c]) return;
    const auto first = keys_.begin() + clusters_.first[c], last = keys_.begin() + clusters_.first[c + 1];
    for (auto key = first; key != last; ++key) {
      std::uint8_t& level = level_[key->second];
      level = static_cast<std::uint8_t>(std::min<int>(level + times, alone));
      key->first = cell(key->second);
    }
    std::sort(first, last);
  });
  number();
}

}  // namespace rayengine
