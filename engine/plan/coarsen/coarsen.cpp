#include "engine/plan/coarsen/coarsen.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "accel/check_mesh.h"
#include "engine/plan/coarsen/given.h"
#include "engine/plan/coarsen/lattice_cells.h"

namespace rayengine {
namespace {

constexpr double side = 2;                // of the lattice, in tolerances: what cells hold then mostly lies within it
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
        joins_(given.vertex_count()) {}

  std::optional<CoarserMesh> run() {
    if (cells_.count() == 0 || double(cells_.count()) > worthwhile_share * double(given_.vertex_count())) return {};
    find_middles();
    number();
    Triangles failing = look_at_all();
    for (int round = 1; round < most_rounds; ++round) {
      if (double(left_.size()) > worthwhile_share * double(given_.triangle_count())) return {};
      const std::vector<char> alone = leave_alone(failing);
      if (alone.empty()) return result();
      failing = look_again(alone);
    }
    return {};
  }

 private:
  using Triangles = std::vector<std::uint32_t>;

  struct Middle {
    glm::dvec3 position;
    double reach = 0;          // to the farthest member within the tolerance
    std::uint32_t joined = 0;  // members within it
    bool together = true;      // whether those become one
  };

  /// Between their mean, which is near the surface, and the middle of their bounds, which none is far from.
  glm::dvec3 middle_of(std::span<const std::uint32_t> members) const {
    Box box;
    glm::dvec3 sum(0);
    for (const std::uint32_t v : members) {
      const glm::dvec3 p = given_.position(v);
      box.add(p), sum += p;
    }
    return glm::dvec3(rounded((box.center() + sum / double(members.size())) / 2.));
  }

  void find_middles() {
    tbb::parallel_for(std::uint32_t{0}, cells_.count(), [&](std::uint32_t c) {
      const auto members = cells_.members(c);
      Middle& m = middles_[c];
      m.position = middle_of(members);
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
    std::vector<std::uint32_t> first(cells_.count() + 1, 0);
    for (std::uint32_t c = 0; c < cells_.count(); ++c)
      first[c + 1] = first[c] + static_cast<std::uint32_t>(cells_.members(c).size()) -
                     (middles_[c].together ? middles_[c].joined - 1 : 0);
    number_.resize(given_.vertex_count());
    tbb::parallel_for(std::uint32_t{0}, cells_.count(), [&](std::uint32_t c) {
      std::uint32_t next = first[c] + middles_[c].together;
      for (const std::uint32_t v : cells_.members(c))
        number_[v] = middles_[c].together && joins_[v] ? first[c] : next++;
    });
    numbers_ = first.back();
  }

  glm::uvec3 moved(const glm::uvec3& t) const { return {number_[t.x], number_[t.y], number_[t.z]}; }

  glm::dvec3 position(std::uint32_t vertex) const {
    const std::uint32_t c = cells_.of(vertex);
    return middles_[c].together && joins_[vertex] ? middles_[c].position : given_.position(vertex);
  }

  /// Whether it faces as it did before.
  bool faces_on(const glm::uvec3& t) const {
    const glm::dvec3 before = area_vector(given_.position(t.x), given_.position(t.y), given_.position(t.z));
    const glm::dvec3 after = area_vector(position(t.x), position(t.y), position(t.z));
    const double product = glm::dot(before, after);
    return product > 0 &&
           product * product > least_cosine * least_cosine * glm::dot(before, before) * glm::dot(after, after);
  }

  /// Notes the ends of the edges of some of what is left, by their lower ends.
  void find_edges(std::span<const std::uint32_t> left) {
    edges_first_.assign(std::size_t{numbers_} + 1, 0);
    used_.resize(numbers_, false);
    std::vector<glm::uvec3> corners(left.size());
    for_each_chunk(left.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) corners[i] = moved(given_.triangle(left[i]));
    });
    const auto each_edge = [&](auto visit) {
      for (const glm::uvec3& t : corners)
        for (int k = 0; k < 3; ++k) visit(std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3]));
    };
    each_edge([&](std::uint32_t a, std::uint32_t b) { ++edges_first_[a + 1], used_[a] = used_[b] = true; });
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

  /// Finds what is left of all triangles; those of which the proof fails, or that fold over.
  Triangles look_at_all() {
    std::array<Triangles, chunks> left, failing;
    given_.each_triangle([&](std::size_t chunk, std::uint32_t i, const glm::uvec3& t) {
      if (!has_three(moved(t))) return;
      left[chunk].push_back(i);
      if (!faces_on(t)) failing[chunk].push_back(i);
    });
    left_ = joined(left);
    find_edges(left_);
    given_.each_triangle([&](std::size_t chunk, std::uint32_t i, const glm::uvec3& given) {
      if (const glm::uvec3 t = moved(given); !has_three(t) && !is_covered(t)) failing[chunk].push_back(i);
    });
    return joined(failing);
  }

  static Triangles joined(const std::array<Triangles, chunks>& lists) {
    Triangles all;
    for (const Triangles& list : lists) all.insert(all.end(), list.begin(), list.end());
    return all;
  }

  /// Of the cells about each of these triangles, that of the fewest vertices is now left alone: a flag for each cell;
  /// no flags if all of them were alone before.
  std::vector<char> leave_alone(const Triangles& failing) {
    std::vector<char> alone;
    for (const std::uint32_t i : failing) {
      const glm::uvec3 t = given_.triangle(i);
      std::array<std::uint32_t, 3> cells{cells_.of(t.x), cells_.of(t.y), cells_.of(t.z)};
      std::ranges::stable_sort(cells, {}, [&](std::uint32_t c) { return middles_[c].joined; });
      const auto is_alone = [&](std::uint32_t c) { return !alone.empty() && alone[c]; };
      const auto least = std::ranges::find_if(cells, [&](std::uint32_t c) { return middles_[c].together; });
      if (least == cells.end() || std::ranges::any_of(cells, is_alone)) continue;
      alone.resize(cells_.count());
      alone[*least] = true;
      middles_[*least].together = false;
    }
    return alone;
  }

  /// Gives back to triangles what they lost to cells that are now left alone, and looks at those again; at no others,
  /// since no edge between vertices of other cells is lost by it. Those that fail, as above.
  Triangles look_again(const std::vector<char>& alone) {
    std::array<Triangles, chunks> lost, held;
    given_.each_triangle([&](std::size_t chunk, std::uint32_t i, const glm::uvec3& t) {
      if (alone[cells_.of(t.x)] || alone[cells_.of(t.y)] || alone[cells_.of(t.z)])
        (has_three(moved(t)) ? held : lost)[chunk].push_back(i);
    });
    separate(alone);
    Triangles left = joined(held), failing, gone;
    for (const std::uint32_t i : joined(lost)) {
      const bool regained = has_three(moved(given_.triangle(i)));
      (regained ? left : gone).push_back(i);
      if (regained) left_.push_back(i);
    }
    find_edges(left);
    for (const std::uint32_t i : left)
      if (!faces_on(given_.triangle(i))) failing.push_back(i);
    for (const std::uint32_t i : gone)
      if (!is_covered(moved(given_.triangle(i)))) failing.push_back(i);
    return failing;
  }

  void separate(const std::vector<char>& alone) {
    for (std::uint32_t c = 0; c < cells_.count(); ++c)
      if (alone[c])
        for (const std::uint32_t v : cells_.members(c))
          if (joins_[v]) number_[v] = numbers_++;
  }

  CoarserMesh result() const {
    CoarserMesh coarser;
    Mesh& made = coarser.mesh;
    std::vector<std::uint32_t> place(numbers_, no_id), vertices;  // by number; the vertices that became them
    made.triangles.reserve(left_.size());
    for (const std::uint32_t i : left_) {
      glm::uvec3 t = given_.triangle(i);
      for (int k = 0; k < 3; ++k) {
        std::uint32_t& p = place[number_[t[k]]];
        if (p == no_id) p = static_cast<std::uint32_t>(vertices.size()), vertices.push_back(t[k]);
        t[k] = p;
      }
      made.triangles.push_back(t);
    }
    made.positions.resize(vertices.size());
    if (given_.has_normals()) made.normals.resize(vertices.size());
    for_each_chunk(vertices.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        made.positions[i] = position(vertices[i]);
        if (given_.has_normals()) made.normals[i] = given_.normal(vertices[i]);
      }
    });
    for (const Middle& m : middles_)
      if (m.together) coarser.distance = std::max(coarser.distance, m.reach);
    return coarser;
  }

  const Given& given_;
  double tolerance_;
  LatticeCells cells_;
  std::vector<Middle> middles_;        // by cell
  std::vector<char> joins_;            // by vertex: whether its cell's middle is within the tolerance
  std::vector<std::uint32_t> number_;  // by vertex: what it becomes
  std::uint32_t numbers_ = 0;
  Triangles left_;  // that keep three corners
  std::vector<std::uint32_t> edges_first_, edges_;
  std::vector<char> used_;  // by number: whether what is left has it for a corner
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
