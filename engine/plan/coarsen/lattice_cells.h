#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "accel/box.h"

namespace rayengine {

/// The cells of a body-centred cubic lattice that hold points, numbered, and the points in each. Of all lattices its
/// cells cover space with the least radius for their volume, sqrt(5)/4 of the lattice's side.
class LatticeCells {
 public:
  /// Each point lies in `box`. Nothing is in any cell where there would be more bricks of 8 x 8 x 8 than can be
  /// numbered.
  LatticeCells(std::span<const glm::vec3> points, const Box& box, double side);

  std::uint32_t count() const { return static_cast<std::uint32_t>(first_.size()) - 1; }
  std::uint32_t of(std::uint32_t point) const { return cell_of_[point]; }
  /// Ascending.
  std::span<const std::uint32_t> members(std::uint32_t cell) const {
    return {members_.data() + first_[cell], members_.data() + first_[cell + 1]};
  }

 private:
  void number(std::vector<std::uint32_t>& keys, std::size_t bricks);
  void sort_members();

  std::vector<std::uint32_t> cell_of_;  // by point
  std::vector<std::uint32_t> first_{0}, members_;
};

}  // namespace rayengine
