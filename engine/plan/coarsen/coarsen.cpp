#include "engine/plan/coarsen/coarsen.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "accel/check_mesh.h"
#include "engine/plan/coarsen/given.h"
#include "engine/plan/coarsen/lattice_cells.h"

namespace rayengine {
namespace {

constexpr double side = 1.9;              // of the lattice, in tolerances: of most cells the radius then is within it
constexpr double worthwhile_share = 0.5;  // of the triangles that may be left
constexpr double least_cosine = 0.1;      // of the normals before and after: no triangle may fold over or stand on edge
constexpr int most_rounds = 6;            // of leaving cells alone where a proof fails

glm::dvec3 area_vector(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  return glm::cross(b - a, c - a);
}

/// What single precision holds takes less room. Not inlined, since g++ 12.2 then leaves two of the three as they are.
[[gnu::noinline]] glm::vec3 rounded(const glm::dvec3& p) { return glm::vec3(p); }

bool has_three(const glm::uvec3& t) { return t.x != t.y && t.y != t.z && t.z != t.x; }

class Coarsening {
 public:
  Coarsening(const Given& given, double tolerance)
      : given_(given),
        tolerance_(tolerance),
        cells_(given.vertices(), given.box(), side * tolerance),
        middles_(cells_.count()),
        joins_(given.vertex_count()),
        stirred_(cells_.count(), true) {}

  std::optional<CoarserMesh> run() {
    if (cells_.count() == 0 || double(cells_.count()) > worthwhile_share * double(given_.vertex_count())) return {};
    find_middles();
    for (int round = 0; round < most_rounds; ++round) {
      number();
      collect();
      if (double(left_.size()) > worthwhile_share * double(given_.triangle_count())) return {};
      if (!leave_alone()) return result();
    }
    return {};
  }

 private:
  struct Middle {
    glm::dvec3 position;
    double reach = 0;          // to the farthest member within the tolerance
    std::uint32_t joined = 0;  // members within it
    bool together = true;      // whether those become one
  };

  struct Left {
    glm::uvec3 corners;    // numbers
    std::uint32_t source;  // a triangle that became it
  };

  void find_middles() {
    tbb::parallel_for(std::uint32_t{0}, cells_.count(), [&](std::uint32_t c) {
      const auto members = cells_.members(c);
      Box box;
      for (const std::uint32_t v : members) box.add(given_.position(v));
      Middle& m = middles_[c];
      m.position = glm::dvec3(rounded(box.center()));
      double farthest = 0;
      for (const std::uint32_t v : members) {
        const glm::dvec3 d = given_.position(v) - m.position;
        joins_[v] = glm::dot(d, d) <= tolerance_ * tolerance_;
        if (joins_[v]) farthest = std::max(farthest, glm::dot(d, d)), ++m.joined;
      }
      m.reach = std::sqrt(farthest);
      m.together = m.joined > 1;
    });
  }

  /// Of the vertices that there will be: in the order of cells.
  void number() {
    first_.assign(cells_.count() + 1, 0);
    for (std::uint32_t c = 0; c < cells_.count(); ++c)
      first_[c + 1] = first_[c] + static_cast<std::uint32_t>(cells_.members(c).size()) -
                      (middles_[c].together ? middles_[c].joined - 1 : 0);
    number_.resize(given_.vertex_count());
    tbb::parallel_for(std::uint32_t{0}, cells_.count(), [&](std::uint32_t c) {
      std::uint32_t next = first_[c] + middles_[c].together;
      for (const std::uint32_t v : cells_.members(c))
        number_[v] = middles_[c].together && joins_[v] ? first_[c] : next++;
    });
  }

  glm::uvec3 moved(const glm::uvec3& t) const { return {number_[t.x], number_[t.y], number_[t.z]}; }

  void collect() {
    std::array<std::vector<Left>, chunks> lists;
    given_.each_triangle([&](std::size_t chunk, std::uint32_t i, const glm::uvec3& given) {
      if (const glm::uvec3 t = moved(given); has_three(t)) lists[chunk].push_back({t, i});
    });
    left_.clear();
    for (const auto& list : lists) left_.insert(left_.end(), list.begin(), list.end());
  }

  glm::dvec3 position(std::uint32_t vertex) const {
    const std::uint32_t c = cells_.of(vertex);
    return middles_[c].together && joins_[vertex] ? middles_[c].position : given_.position(vertex);
  }

  /// Whether it faces as it did before.
  bool faces_on(const Left& left) const {
    const glm::uvec3 t = given_.triangle(left.source);
    const glm::dvec3 before = area_vector(given_.position(t.x), given_.position(t.y), given_.position(t.z));
    const glm::dvec3 after = area_vector(position(t.x), position(t.y), position(t.z));
    const double product = glm::dot(before, after);
    return product > 0 &&
           product * product > least_cosine * least_cosine * glm::dot(before, before) * glm::dot(after, after);
  }

  /// The ends of the edges of triangles that are left, by their lower ends.
  void find_edges() {
    edges_first_.assign(std::size_t{first_.back()} + 1, 0);
    const auto each_edge = [&](auto visit) {
      for (const Left& l : left_)
        for (int k = 0; k < 3; ++k) {
          const std::uint32_t a = l.corners[k], b = l.corners[(k + 1) % 3];
          visit(std::min(a, b), std::max(a, b));
        }
    };
    each_edge([&](std::uint32_t a, std::uint32_t) { ++edges_first_[a + 1]; });
    for (std::size_t i = 1; i < edges_first_.size(); ++i) edges_first_[i] += edges_first_[i - 1];
    edges_.resize(edges_first_.back());
    std::vector<std::uint32_t> next(edges_first_.begin(), edges_first_.end() - 1);
    each_edge([&](std::uint32_t a, std::uint32_t b) { edges_[next[a]++] = b; });
  }

  /// Whether what a triangle became is an edge, or an end of an edge, of one that is left.
  bool is_covered(const glm::uvec3& t) const {
    const std::uint32_t a = std::min({t.x, t.y, t.z}), b = std::max({t.x, t.y, t.z});
    if (a == b) return used_[a];
    const auto last = edges_.begin() + edges_first_[a + 1];
    return std::find(edges_.begin() + edges_first_[a], last, b) != last;
  }

  /// Leaves cells alone about triangles of which the proof fails, or that fold over; says whether there were any.
  bool leave_alone() {
    find_edges();
    used_.assign(first_.back(), false);
    for (const Left& l : left_)
      for (int k = 0; k < 3; ++k) used_[l.corners[k]] = true;
    std::array<std::vector<std::uint32_t>, chunks> failing;
    given_.each_triangle([&](std::size_t chunk, std::uint32_t i, const glm::uvec3& given) {
      if (!any_corner(given, stirred_)) return;
      const glm::uvec3 t = moved(given);
      if (has_three(t) ? !faces_on({t, i}) : !is_covered(t)) failing[chunk].push_back(i);
    });
    std::vector<char> left_alone(cells_.count());
    bool any = false;
    for (const auto& list : failing)
      for (const std::uint32_t i : list)
        for (int k = 0; k < 3; ++k) {
          const std::uint32_t c = cells_.of(given_.triangle(i)[k]);
          if (!middles_[c].together) continue;
          any = true, left_alone[c] = true;
          middles_[c].together = false;
        }
    if (any) stir(left_alone);
    return any;
  }

  bool any_corner(const glm::uvec3& t, const std::vector<char>& cells) const {
    return cells[cells_.of(t.x)] || cells[cells_.of(t.y)] || cells[cells_.of(t.z)];
  }

  /// Has those cells looked at again, and all where edges may be gone for it.
  void stir(const std::vector<char>& left_alone) {
    stirred_ = left_alone;
    for (const Left& l : left_)
      if (const glm::uvec3 t = given_.triangle(l.source); any_corner(t, left_alone))
        for (int k = 0; k < 3; ++k) stirred_[cells_.of(t[k])] = true;
  }

  CoarserMesh result() const {
    CoarserMesh coarser;
    Mesh& made = coarser.mesh;
    std::vector<std::uint32_t> place(used_.size(), no_id);
    for (std::uint32_t c = 0; c < cells_.count(); ++c) {
      if (middles_[c].together) coarser.distance = std::max(coarser.distance, middles_[c].reach);
      for (const std::uint32_t v : cells_.members(c)) {
        std::uint32_t& p = place[number_[v]];
        if (!used_[number_[v]] || p != no_id) continue;
        p = static_cast<std::uint32_t>(made.positions.size());
        made.positions.push_back(position(v));
        if (given_.has_normals()) made.normals.push_back(given_.normal(v));
      }
    }
    made.triangles.reserve(left_.size());
    for (const Left& l : left_) made.triangles.emplace_back(place[l.corners.x], place[l.corners.y], place[l.corners.z]);
    return coarser;
  }

  const Given& given_;
  double tolerance_;
  LatticeCells cells_;
  std::vector<Middle> middles_;        // by cell
  std::vector<char> joins_;            // by vertex: whether its cell's middle is within the tolerance
  std::vector<char> stirred_;          // by cell: whether its triangles are to be looked at
  std::vector<std::uint32_t> first_;   // number of each cell
  std::vector<std::uint32_t> number_;  // by vertex: what it becomes
  std::vector<Left> left_;
  std::vector<std::uint32_t> edges_first_, edges_;
  std::vector<char> used_;  // by number
};

}  // namespace

std::optional<CoarserMesh> coarsen(const Geometry& geometry, std::uint32_t object, double tolerance) {
  check_tolerance(tolerance);
  const Given given(geometry, object);
  const double roundings = 16 * 0x1p-53 * given.box().extent();
  if (given.triangle_count() == 0 || !(roundings < 0.5 * tolerance)) return {};
  std::optional<CoarserMesh> found = Coarsening(given, tolerance - roundings).run();
  if (found) found->distance += roundings;
  return found;
}

}  // namespace rayengine
