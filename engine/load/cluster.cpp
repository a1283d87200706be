#include "engine/load/cluster.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <tuple>

#include "accel/ray.h"
#include "engine/load/cells.h"
#include "engine/load/incidence.h"
#include "engine/load/surface_distance.h"

namespace rayengine {
namespace {

using Positions = std::span<const glm::dvec3>;
using Triangles = std::span<const glm::uvec3>;

constexpr int most_rounds = 12;
constexpr int most_tried = 32;        // coarse triangles for each part of an original one
constexpr double near_enough = 0.3;   // of a limit: no nearer coarse triangle is looked for
constexpr double least_cosine = 0.1;  // of the normals before and after: no triangle may fold over or stand on edge
constexpr int most_nodes = 32;        // along an edge of a coarse one

constexpr std::size_t sample = 1024;      // triangles that are looked at first
constexpr double hopeless_share = 0.5;    // of them that fail
constexpr double worthwhile_share = 0.5;  // of triangles that may be left

/// No point of a triangle is farther from all of its corners than its longest edge by this.
constexpr double root_3 = std::numbers::sqrt3;

struct CoarseTriangle {
  glm::uvec3 corners;    // clusters, the lowest first
  std::uint32_t source;  // the first triangle that became it
};

class Clustering {
 public:
  Clustering(Positions positions, Triangles triangles, double limit)
      : positions_(positions),
        triangles_(triangles),
        limit_(limit),
        cells_(positions, triangles, limit),
        of_vertex_(positions.size(), triangles, [](const glm::uvec3& t) { return t; }),
        stir_(positions.size(), Stir::own),
        nearness_(positions.size(), infinity) {}

  std::vector<glm::uvec3> run() {
    for (int round = 0; round < most_rounds; ++round) {
      collect();
      if (double(coarse_.size()) > worthwhile_share * double(triangles_.size())) break;  // more cells leave more
      if (!refine(round)) return result();
    }
    return {triangles_.begin(), triangles_.end()};
  }

 private:
  Corners corners_of(const CoarseTriangle& k) const {
    return corners(positions_, {clusters_.representative[k.corners.x], clusters_.representative[k.corners.y],
                                clusters_.representative[k.corners.z]});
  }

  /// The triangles whose corners are in three clusters, each once for either side.
  void collect() {
    coarse_.clear();
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      const glm::uvec3& t = triangles_[i];
      glm::uvec3 c(clusters_.of[t.x], clusters_.of[t.y], clusters_.of[t.z]);
      if (c.x == c.y || c.y == c.z || c.z == c.x) continue;
      while (c.x > c.y || c.x > c.z) c = {c.y, c.z, c.x};
      coarse_.push_back({c, i});
    }
    const auto order = [](const CoarseTriangle& k) {
      return std::tie(k.corners.x, k.corners.y, k.corners.z, k.source);
    };
    tbb::parallel_sort(coarse_, [&](const auto& a, const auto& b) { return order(a) < order(b); });
    const auto same = [](const auto& a, const auto& b) { return a.corners == b.corners; };
    coarse_.erase(std::unique(coarse_.begin(), coarse_.end(), same), coarse_.end());
    std::erase_if(coarse_, [&](const auto& k) { return area_vector(corners_of(k)) == glm::dvec3(0); });
    coarse_corners_.clear();
    for (const CoarseTriangle& k : coarse_) coarse_corners_.push_back(corners_of(k));
    stars_ = Incidence(clusters_.count(), std::span<const CoarseTriangle>(coarse_),
                       [](const CoarseTriangle& k) { return k.corners; });
  }

  /// Whether one coarse triangle at these clusters is near all of a part of an original one.
  bool is_near_coarse(const Corners& part, const glm::uvec3& clusters) const {
    int tried = 0;
    for (int i = 0; i < 3; ++i)
      for (const std::uint32_t k : stars_[clusters[i]]) {
        if (is_within(part, coarse_corners_[k], limit_ * limit_)) return true;
        if (++tried == most_tried) return false;
      }
    return false;
  }

  /// Whether that is so of a triangle, or of the four parts of it.
  bool is_kept(const glm::uvec3& t) const {
    const Corners whole = corners(positions_, t);
    const glm::uvec3 clusters(clusters_.of[t.x], clusters_.of[t.y], clusters_.of[t.z]);
    if (is_near_coarse(whole, clusters)) return true;
    if (longest_edge(whole) < 0.5 * limit_) return false;
    return std::ranges::all_of(quartered(whole), [&](const Corners& part) { return is_near_coarse(part, clusters); });
  }

  /// A bound on a vertex's distance from the coarse triangles at its cluster.
  double distance_from_coarse(std::uint32_t v) const {
    double least = infinity;
    int tried = 0;
    for (const std::uint32_t k : stars_[clusters_.of[v]]) {
      least = std::min(least, squared_distance(positions_[v], coarse_corners_[k]));
      if (least <= near_enough * near_enough * limit_ * limit_ || ++tried == most_tried) break;
    }
    return std::sqrt(least);
  }

  /// Whether the node is that near to an original triangle at the vertex of a cluster that is nearest to it.
  bool is_near_original(const glm::dvec3& node, std::uint32_t cluster, double squared_radius) const {
    double least = infinity;
    std::uint32_t nearest = 0;
    for (const std::uint32_t v : clusters_.members_of(cluster))
      if (const glm::dvec3 d = positions_[v] - node; glm::dot(d, d) < least) least = glm::dot(d, d), nearest = v;
    return std::ranges::any_of(of_vertex_[nearest], [&](std::uint32_t t) {
      return squared_distance(node, corners(positions_, triangles_[t])) <= squared_radius;
    });
  }

  /// Whether all of a coarse triangle is near the original: cut into parts of which no point is farther than `cover`
  /// limits from a corner, all corners are as near to the original as the rest of the limit.
  bool is_covered(std::size_t index, double cover) const {
    const Corners& c = coarse_corners_[index];
    const glm::uvec3& clusters = coarse_[index].corners;
    const double n = std::ceil(longest_edge(c) / (cover * limit_ * root_3)), radius = (1 - cover) * limit_;
    if (n > most_nodes) return false;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) {
        const glm::dvec3 node = ((n - i - j) * c[0] + double(i) * c[1] + double(j) * c[2]) / n;
        const int corner = 2 * i + j >= n ? 1 : i + 2 * j >= n ? 2 : 0;  // whose cluster is the likeliest
        bool is_near = false;
        for (int k = 0; k < 3 && !is_near; ++k)
          is_near = is_near_original(node, clusters[(corner + k) % 3], radius * radius);
        if (!is_near) return false;
      }
    return true;
  }

  /// Whether a coarse triangle is near the original, one triangle of it or more, and faces as it does.
  bool is_founded(std::size_t index) const {
    const CoarseTriangle& k = coarse_[index];
    const Corners& c = coarse_corners_[index];
    if (is_within(c, corners(positions_, triangles_[k.source]), limit_ * limit_)) return true;
    const glm::dvec3 before =
        clusters_.normals[k.corners.x] + clusters_.normals[k.corners.y] + clusters_.normals[k.corners.z];
    const glm::dvec3 now = area_vector(c);
    return glm::dot(now, before) > least_cosine * glm::length(now) * glm::length(before) &&
           (is_covered(index, 0.75) || is_covered(index, 0.5));
  }

  bool is_new(const CoarseTriangle& k) const {
    return std::max({stir_[clusters_.representative[k.corners.x]], stir_[clusters_.representative[k.corners.y]],
                     stir_[clusters_.representative[k.corners.z]]}) == Stir::own;
  }
  bool is_lost(const glm::uvec3& t) const {
    if (std::max({stir_[t.x], stir_[t.y], stir_[t.z]}) == Stir::none) return false;
    const double corner = std::max({nearness_[t.x], nearness_[t.y], nearness_[t.z]});
    return corner + longest_edge(corners(positions_, t)) / root_3 > limit_ && !is_kept(t);
  }
  bool is_unfounded(std::size_t k) const { return is_new(coarse_[k]) && !is_founded(k); }

  /// Whether so many of some triangles fail that it is not worth the while to look at all.
  bool is_hopeless() const {
    const std::size_t step = triangles_.size() / sample + 1, coarse_step = coarse_.size() / sample + 1;
    std::size_t lost = 0, unfounded = 0;
    for (std::size_t i = 0; i < triangles_.size(); i += step) lost += is_lost(triangles_[i]);
    for (std::size_t k = 0; k < coarse_.size(); k += coarse_step) unfounded += is_unfounded(k);
    return double(lost * step) > hopeless_share * double(triangles_.size()) ||
           double(unfounded * coarse_step) > hopeless_share * double(coarse_.size());
  }

  /// Clusters where the proof fails, of those where it has to be made anew.
  std::vector<char> failures() {
    tbb::parallel_for(std::uint32_t{0}, static_cast<std::uint32_t>(positions_.size()), [&](std::uint32_t v) {
      if (stir_[v] != Stir::none && clusters_.of[v] != no_id) nearness_[v] = distance_from_coarse(v);
    });

    std::vector<char> lost(triangles_.size()), unfounded(coarse_.size()), fails(clusters_.count());
    tbb::parallel_for(std::size_t{0}, lost.size(), [&](std::size_t i) { lost[i] = is_lost(triangles_[i]); });
    tbb::parallel_for(std::size_t{0}, unfounded.size(), [&](std::size_t k) { unfounded[k] = is_unfounded(k); });
    for (std::size_t i = 0; i < lost.size(); ++i)
      for (int k = 0; lost[i] && k < 3; ++k) fails[clusters_.of[triangles_[i][k]]] = true;
    for (std::size_t i = 0; i < unfounded.size(); ++i)
      for (int k = 0; unfounded[i] && k < 3; ++k) fails[coarse_[i].corners[k]] = true;
    return fails;
  }

  /// Marks what the proof has to be made for anew once clusters that fail are split: they, and all at whose triangles
  /// they have a corner.
  void stir(const std::vector<char>& fails) {
    std::vector<char> touched = fails;
    for (const CoarseTriangle& k : coarse_)
      if (fails[k.corners.x] || fails[k.corners.y] || fails[k.corners.z])
        for (int i = 0; i < 3; ++i) touched[k.corners[i]] = true;
    for (std::uint32_t v = 0; v < positions_.size(); ++v) {
      const std::uint32_t c = clusters_.of[v];
      if (c == no_id) continue;
      stir_[v] = fails[c] ? Stir::own : touched[c] ? Stir::neighbour : Stir::none;
      if (stir_[v] != Stir::none) nearness_[v] = infinity;
    }
  }

  /// Halves the cells where the proof fails; says whether there were any.
  bool refine(int round) {
    const bool hopeless = is_hopeless();
    const std::vector<char> fails = hopeless ? std::vector<char>(clusters_.count(), true) : failures();
    stir(fails);
    if (std::ranges::count(fails, true) == 0) return false;
    cells_.split(fails, round >= most_rounds / 2 ? Cells::levels : hopeless ? 2 : 1);
    return true;
  }

  std::vector<glm::uvec3> result() const {
    std::vector<glm::uvec3> list;
    for (const CoarseTriangle& k : coarse_)
      list.push_back({clusters_.representative[k.corners.x], clusters_.representative[k.corners.y],
                      clusters_.representative[k.corners.z]});
    return list;
  }

  const Positions positions_;
  const Triangles triangles_;
  const double limit_;
  Cells cells_;
  const Clusters& clusters_ = cells_.clusters();
  std::vector<CoarseTriangle> coarse_;
  std::vector<Corners> coarse_corners_;
  Incidence of_vertex_;  // original triangles
  Incidence stars_;      // coarse triangles of a cluster
  enum class Stir : char { none, neighbour, own };
  std::vector<Stir> stir_;        // by vertex: what happened to its cluster in the round before
  std::vector<double> nearness_;  // by vertex: a bound on its distance from the coarse triangles
};

}  // namespace

std::vector<glm::uvec3> cluster(Positions positions, Triangles triangles, double limit) {
  return Clustering(positions, triangles, limit).run();
}

}  // namespace rayengine
