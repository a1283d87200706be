#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "accel/geometry.h"
#include "engine/plan/coarsen/side_by_side.h"

namespace rayengine {

/// The vertices and triangles of an object, numbered from 0.
class Given {
 public:
  Given(const Geometry& g, std::uint32_t object) : g_(g), triangles_(triangles_of(g, object)) {
    std::array<std::pair<std::uint32_t, std::uint32_t>, chunks> ranges;
    for_each_chunk(triangles_.size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      ranges[chunk] = vertex_range(triangles_.subspan(begin, end - begin));
    });
    for (const auto& [begin, end] : ranges)
      if (begin < end) first_ = std::min(first_, begin), end_ = std::max(end_, end);
    first_ = std::min(first_, end_);
    find_box();
  }

  std::size_t vertex_count() const { return end_ - first_; }
  std::size_t triangle_count() const { return triangles_.size(); }
  /// As single precision sees them.
  std::span<const glm::vec3> vertices() const { return std::span(g_.vertices).subspan(first_, vertex_count()); }
  glm::uvec3 triangle(std::size_t i) const { return triangles_[i] - first_; }
  bool has_normals() const { return !g_.normals.empty(); }
  glm::vec3 normal(std::uint32_t v) const { return g_.normals[first_ + v]; }
  glm::dvec3 position(std::uint32_t v) const { return g_.vertex(first_ + v); }

  /// Calls visit(chunk, number, corners) for each triangle given.
  template <class Visit>
  void each_triangle(Visit visit) const {
    for_each_chunk(triangle_count(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) visit(chunk, static_cast<std::uint32_t>(i), triangle(i));
    });
  }

  const Box& box() const { return box_; }

 private:
  void find_box() {
    std::array<Box, chunks> boxes;
    for_each_chunk(vertex_count(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) boxes[chunk].add(position(static_cast<std::uint32_t>(v)));
    });
    for (const Box& box : boxes) box_.add(box);
  }

  const Geometry& g_;
  std::span<const glm::uvec3> triangles_;
  std::uint32_t first_ = no_id, end_ = 0;
  Box box_;
};

}  // namespace rayengine
