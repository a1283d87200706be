#include "engine/plan/coarsen/lattice_cells.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <glm/geometric.hpp>
#include <numeric>

namespace rayengine {
namespace {

constexpr double most_bricks = 1 << 22;
constexpr std::size_t grain = 1 << 14;

/// Calls work(i) for each of so many, on all threads.
template <class Work>
void for_each_index(std::size_t count, Work work) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) work(i);
  });
}

/// Others may write the same at the same time.
void mark(std::uint32_t& place) { std::atomic_ref(place).store(0, std::memory_order_relaxed); }

/// Numbers what is marked, in order.
std::uint32_t number_marked(std::span<std::uint32_t> places) {
  std::uint32_t count = 0;
  for (std::uint32_t& place : places)
    if (place != no_id) place = count++;
  return count;
}

/// The point of the lattice that is nearest to one without negative coordinates: of the corners of its cubes, or of
/// their middles. The latter are told by odd z.
glm::ivec3 nearest(const glm::vec3& p) {
  const glm::ivec3 corner(p + 0.5f), middle(p);
  const glm::vec3 a = p - glm::vec3(corner), b = p - glm::vec3(middle) - 0.5f;
  const bool at_corner = glm::dot(a, a) <= glm::dot(b, b);
  glm::ivec3 at = at_corner ? corner : middle;
  at.z = 2 * at.z + !at_corner;
  return at;
}

}  // namespace

LatticeCells::LatticeCells(std::span<const glm::vec3> points, const Box& box, double side) {
  const glm::dvec3 bricks = glm::floor((box.size() / side + 1.) * glm::dvec3(1, 1, 2) / 8.) + 1.;
  if (!(bricks.x * bricks.y * bricks.z <= most_bricks)) return;
  const glm::ivec3 size(bricks);
  std::vector<std::uint32_t> keys(points.size());  // a brick, and 9 bits within
  const glm::vec3 lower(box.lower);
  const auto per_side = static_cast<float>(1 / side);
  for_each_index(points.size(), [&](std::size_t i) {
    const glm::uvec3 at(glm::clamp(nearest((points[i] - lower) * per_side), glm::ivec3(0), 8 * size - 1));
    const glm::uvec3 brick = at >> 3u, in = at & 7u;
    keys[i] = ((brick.z * size.y + brick.y) * size.x + brick.x) << 9 | in.z << 6 | in.y << 3 | in.x;
  });
  number(keys, static_cast<std::size_t>(size.x) * size.y * size.z);
  sort_members();
}

void LatticeCells::number(std::vector<std::uint32_t>& keys, std::size_t bricks) {
  std::vector<std::uint32_t> brick_at(bricks, no_id);
  for_each_index(keys.size(), [&](std::size_t i) { mark(brick_at[keys[i] >> 9]); });
  std::vector<std::uint32_t> cell_at(std::size_t{number_marked(brick_at)} << 9, no_id);
  for_each_index(keys.size(), [&](std::size_t i) {
    keys[i] = brick_at[keys[i] >> 9] << 9 | (keys[i] & 511);
    mark(cell_at[keys[i]]);
  });
  first_.assign(std::size_t{number_marked(cell_at)} + 1, 0);
  for_each_index(keys.size(), [&](std::size_t i) { keys[i] = cell_at[keys[i]]; });
  cell_of_ = std::move(keys);
}

void LatticeCells::sort_members() {
  for (const std::uint32_t c : cell_of_) ++first_[c + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  members_.resize(cell_of_.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t i = 0; i < cell_of_.size(); ++i) members_[next[cell_of_[i]]++] = i;
}

}  // namespace rayengine
