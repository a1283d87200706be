#include "accel/grid.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "accel/rounding.h"
#include "accel/tracer.h"
#include "accel/voxel_overlap.h"

namespace rayengine {
namespace {

/// A primitive in a voxel.
struct Member {
  std::uint32_t voxel, primitive;
};

/// What a build may take, in tests of a voxel against a primitive.
double most_tests(std::size_t primitives) { return 0x1p20 + 64. * static_cast<double>(primitives); }

Box in_frame(const Box& box, const LocalFrame& frame) {
  return {(box.lower - frame.center) * frame.scale - grid_margin,
          (box.upper - frame.center) * frame.scale + grid_margin};
}

/// The side of cubes of which `voxels` fill a box, thin axes left out.
double cube_side(const glm::dvec3& size, const glm::bvec3& thin, double voxels) {
  double volume = 1;
  int axes = 0;
  for (int i = 0; i < 3; ++i)
    if (!thin[i]) volume *= size[i], ++axes;
  return axes == 0 ? 0 : std::pow(volume / voxels, 1. / axes);
}

class GridBuilder {
 public:
  GridBuilder(const Geometry& geometry, const GridOptions& options)
      : geometry_(geometry), options_(options), primitives_(treelet_primitives(geometry)) {
    grid_.lists.frame = LocalFrame(frame_bounds(geometry));
    lay_out();
  }

  Grid build() {
    std::vector<std::uint32_t> unbounded;
    for (std::uint32_t i = 0; i < primitives_.size(); ++i) primitives_[i].bounded() ? enter(i) : unbounded.push_back(i);
    list();
    grid_.lists.unbounded = append_treelet(grid_.lists, primitives_, unbounded);
    return std::move(grid_);
  }

 private:
  const LocalFrame& frame() const { return grid_.lists.frame; }

  /// Chooses the voxels: fewer where primitives are so large that most would be in very many of them.
  void lay_out() {
    Box all;
    std::size_t bounded = 0;
    for (const TreeletPrimitive& p : primitives_)
      if (p.bounded()) all.add(in_frame(p.bounds, frame())), ++bounded;
    if (all.empty()) all.add(glm::dvec3(0));
    GridOptions options = options_;
    lay_out(all, grid_counts(all.size(), bounded, options));
    for (; overlap_tests() > most_tests(bounded) && grid_.counts != glm::uvec3(1); options.density /= 2)
      lay_out(all, grid_counts(all.size(), bounded, options));
    grid_.voxels.assign(std::size_t{grid_.counts.x} * grid_.counts.y * grid_.counts.z, no_id);
  }

  /// Planes are products and sums of what single precision holds, as shaders form them.
  void lay_out(const Box& all, const glm::uvec3& counts) {
    grid_.counts = counts;
    for (int i = 0; i < 3; ++i) {
      grid_.lower[i] = float_below(all.lower[i]);
      const double size = all.upper[i] - static_cast<double>(grid_.lower[i]);
      grid_.cell[i] = float_above(std::max(size, grid_margin) / counts[i] * (1 + 0x1p-22));
    }
  }

  /// Voxels within the bounds of primitives, over all of these.
  double overlap_tests() const {
    double tests = 0;
    for (const TreeletPrimitive& p : primitives_) {
      if (!p.bounded()) continue;
      const Box box = in_frame(p.bounds, frame());
      const glm::dvec3 span(voxel_at(box.upper) - voxel_at(box.lower) + 1u);
      tests += span.x * span.y * span.z;
    }
    return tests;
  }

  Voxel voxel(const glm::uvec3& at) const {
    const glm::dvec3 cell(grid_.cell);
    return {glm::dvec3(grid_.lower) + (glm::dvec3(at) + 0.5) * cell, 0.5 * cell + grid_margin};
  }

  glm::uvec3 voxel_at(const glm::dvec3& p) const {
    const glm::dvec3 index = glm::floor((p - glm::dvec3(grid_.lower)) / glm::dvec3(grid_.cell));
    return glm::uvec3(glm::clamp(index, glm::dvec3(0), glm::dvec3(grid_.counts) - 1.));
  }

  /// Enters a primitive into all voxels between two for which `overlaps` holds.
  template <class Overlaps>
  void enter_where(std::uint32_t primitive, const glm::uvec3& first, const glm::uvec3& last, const Overlaps& overlaps) {
    for (std::uint32_t z = first.z; z <= last.z; ++z)
      for (std::uint32_t y = first.y; y <= last.y; ++y)
        for (std::uint32_t x = first.x; x <= last.x; ++x)
          if (overlaps(voxel({x, y, z}))) add({(z * grid_.counts.y + y) * grid_.counts.x + x, primitive});
  }

  void enter(std::uint32_t i) {
    const TreeletPrimitive& p = primitives_[i];
    const Box box = in_frame(p.bounds, frame());
    const glm::uvec3 first = voxel_at(box.lower), last = voxel_at(box.upper);
    if (first == last) return enter_where(i, first, last, [](const Voxel&) { return true; });
    if (p.type == TreeletPrimitive::triangle)
      enter_where(i, first, last, [corners = corners(p.id)](const Voxel& v) { return overlaps(corners, v); });
    else
      enter_where(i, first, last,
                  [surface = QuadricSurface(geometry_, geometry_.quadrics[p.id], frame())](const Voxel& v) {
                    return surface.overlaps(v);
                  });
  }

  std::array<glm::dvec3, 3> corners(std::uint32_t triangle) const {
    std::array<glm::dvec3, 3> result;
    for (int i = 0; i < 3; ++i)
      result[static_cast<std::size_t>(i)] =
          (geometry_.vertex(geometry_.triangles[triangle][i]) - frame().center) * frame().scale;
    return result;
  }

  void add(const Member& member) {
    members_.push_back(member);
    if (members_.size() > options_.most_members)
      throw Error("a grid of " + std::to_string(grid_.counts.x) + " x " + std::to_string(grid_.counts.y) + " x " +
                  std::to_string(grid_.counts.z) + " voxels lists the scene's " + std::to_string(primitives_.size()) +
                  " primitives more than " + std::to_string(options_.most_members) +
                  " times, the most that it can hold; use --tracer stream");
  }

  /// Turns the members into lists, in the order of their voxels.
  void list() {
    std::vector<std::uint32_t> first(grid_.voxels.size() + 1), sorted(members_.size());
    for (const Member& m : members_) ++first[m.voxel + 1];
    for (std::size_t v = 0; v < grid_.voxels.size(); ++v) first[v + 1] += first[v];
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (const Member& m : members_) sorted[next[m.voxel]++] = m.primitive;
    for (std::size_t v = 0; v < grid_.voxels.size(); ++v) {
      if (first[v] == first[v + 1]) continue;
      grid_.voxels[v] = static_cast<std::uint32_t>(grid_.lists.treelets.size());
      grid_.lists.treelets.push_back(
          append_treelet(grid_.lists, primitives_, std::span(sorted).subspan(first[v], first[v + 1] - first[v])));
    }
  }

  const Geometry& geometry_;
  const GridOptions& options_;
  std::vector<TreeletPrimitive> primitives_;
  Grid grid_;
  std::vector<Member> members_;
};

}  // namespace

glm::uvec3 grid_counts(const glm::dvec3& size, std::size_t primitives, const GridOptions& options) {
  const double voxels = options.density * static_cast<double>(std::max<std::size_t>(primitives, 1));
  glm::bvec3 thin(false), known(true);
  double side = 0;
  while (thin != known) {  // an axis less makes the cubes along the others smaller
    known = thin;
    side = cube_side(size, thin, voxels);
    thin = thin || glm::lessThanEqual(size, glm::dvec3(side));
  }
  glm::uvec3 counts(1);
  for (int i = 0; i < 3; ++i)
    if (!thin[i])
      counts[i] = static_cast<std::uint32_t>(
          std::clamp(std::round(size[i] / side), 1., static_cast<double>(options.most_along_axis)));
  return counts;
}

Grid build_grid(const Geometry& geometry, const GridOptions& options) { return GridBuilder(geometry, options).build(); }

}  // namespace rayengine
