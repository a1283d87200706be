#include "engine/plan/recognise/recognise.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <glm/trigonometric.hpp>
#include <numeric>
#include <string>

#include "accel/check_mesh.h"
#include "accel/tracer.h"
#include "engine/plan/recognise/caps.h"
#include "engine/plan/recognise/check.h"
#include "engine/plan/recognise/cracks.h"
#include "engine/plan/recognise/doubled.h"
#include "engine/plan/recognise/fit.h"
#include "engine/plan/recognise/grow.h"
#include "engine/plan/recognise/shape.h"

namespace rayengine {
namespace {

using namespace surfaces;

/// Degrees at which neighbours meet within a patch, one try after the other: what coarse tubes need, then less, so that
/// patches come apart along finer edges.
constexpr std::array angles{50., 20., 7.};

/// Degrees by which neighbours in one plane may differ, as rounded coordinates make them.
constexpr double flat = 0.1;

/// What a region may be, and the bound if it is.
struct Verdict {
  Candidate candidate;
  std::optional<double> residual;
};

class Recogniser {
 public:
  Recogniser(const Mesh& mesh, double tolerance) : mesh_(mesh), tolerance_(tolerance), waiting_(mesh.triangles.size()) {
    std::iota(waiting_.begin(), waiting_.end(), 0u);
  }

  Recognition run(Pieces pieces) {
    find_whole(topology(mesh_.triangles), false);
    if (pieces == Pieces::parts && waiting_.size() >= fewest_triangles) {
      const std::vector<glm::uvec3> welded = weld(mesh_.positions, mesh_.triangles, waiting_);
      Topology mesh = topology(welded);
      find_whole(mesh, true);
      add_normals(mesh);
      judged_size_.resize(mesh.triangles.size());
      for (const double degrees : angles) find_patches(mesh, degrees);
      find_patches(mesh, flat);
      find_between_plates(mesh);
      grow(mesh);
      close_with_caps(found_, tolerance_);
      give_back(take_back_cracked(mesh, found_, tolerance_));
    }
    std::ranges::sort(found_, {}, [](const Found& f) { return f.triangles[0]; });
    Recognition result;
    for (Found& f : found_)
      result.quadrics.push_back({shape_of(f.candidate), f.candidate.to_world, std::move(f.triangles), f.residual});
    result.rest = std::move(waiting_);
    return result;
  }

 private:
  Topology topology(std::span<const glm::uvec3> triangles) const {
    return {mesh_.positions, triangles, find_twins(triangles, waiting_, mesh_.positions.size()), {}};
  }

  template <class Judge>
  std::vector<std::optional<Verdict>> judge_all(const Topology& mesh, const Regions& regions, Judge judge) const {
    std::vector<std::optional<Verdict>> verdicts(regions.size());
    tbb::parallel_for(std::size_t{0}, regions.size(), [&](std::size_t i) {
      if (regions[i].size() >= fewest_triangles)
        verdicts[i] = judge({{mesh, regions[i]}, regions, static_cast<std::uint32_t>(i)});
    });
    return verdicts;
  }

  Verdict verdict(const Region& region, const Candidate& candidate) const {
    return {candidate, proven_residual(region, candidate, tolerance_)};
  }

  /// Spheres, and ellipsoids if those are wanted, that are whole connected pieces of the triangles that wait.
  void find_whole(const Topology& mesh, bool ellipsoids) {
    const Regions pieces = connected(mesh, waiting_, [](std::uint32_t) { return true; });
    auto verdicts = judge_all(mesh, pieces, [&](const Region& region) -> std::optional<Verdict> {
      if (const auto sphere = fit_sphere(region))
        if (const Verdict v = verdict(region, *sphere); v.residual || !ellipsoids) return v;
      const auto ellipsoid = ellipsoids ? fit_quadric(region) : std::nullopt;
      if (!ellipsoid || ellipsoid->type != QuadricType::sphere) return {};
      return verdict(region, *ellipsoid);
    });
    withdraw_doubled(verdicts);
    take(pieces, verdicts);
  }

  /// Patches are parts of those that were judged before: one of the same size is the same again.
  bool was_judged(const Region& region) {
    const auto size = static_cast<std::uint32_t>(region.triangles.size());
    if (judged_size_[region.triangles[0]] == size) return true;
    for (const std::uint32_t t : region.triangles) judged_size_[t] = size;
    return false;
  }

  /// Of the triangles that wait.
  void add_normals(Topology& mesh) const {
    mesh.normals.resize(mesh.triangles.size());
    tbb::parallel_for(std::size_t{0}, waiting_.size(),
                      [&](std::size_t i) { mesh.normals[waiting_[i]] = normal(mesh, mesh.triangles[waiting_[i]]); });
  }

  /// Whether a half-edge's triangles meet at less than an angle.
  static auto smooth(const Topology& mesh, double degrees) {
    return [&mesh, cosine = std::cos(glm::radians(degrees))](std::uint32_t h) {
      return glm::dot(mesh.normals[h / 3], mesh.normals[mesh.twins[h] / 3]) > cosine;
    };
  }

  template <class Joins>
  void find_patches(const Topology& mesh, Joins joins) {
    const Regions patches = connected(mesh, waiting_, joins);
    take(patches, judge_all(mesh, patches, [&](const Region& region) {
           return was_judged(region) ? std::nullopt : judge_patch(region);
         }));
  }
  void find_patches(const Topology& mesh, double degrees) { find_patches(mesh, smooth(mesh, degrees)); }

  /// Curved pieces that run smoothly into flat ones, as fillets do: what is flat over more than a facet of a tube
  /// bounds them.
  void find_between_plates(const Topology& mesh) {
    const Regions flats = connected(mesh, waiting_, smooth(mesh, flat));
    const auto is_plate = [&](std::uint32_t t) { return flats.of(t) != no_id && flats[flats.of(t)].size() > 2; };
    for (const double degrees : angles)
      find_patches(mesh, [&, gentle = smooth(mesh, degrees)](std::uint32_t h) {
        return !is_plate(h / 3) && !is_plate(mesh.twins[h] / 3) && gentle(h);
      });
  }

  void grow(const Topology& mesh) {
    const Regions grown = grow_cylinders(mesh, waiting_);
    take(grown, judge_all(mesh, grown, [&](const Region& region) { return judge_patch(region); }));
  }

  std::optional<Verdict> judge_patch(const Region& region) const {
    for (const auto fit : {fit_plates, fit_tubes, fit_others})
      for (const Candidate& c : fit(region))
        if (const Verdict v = verdict(region, c); v.residual) return v;
    return {};
  }

  static std::vector<Candidate> fit_others(const Region& region) {
    std::vector<Candidate> found;
    if (const auto c = fit_zone(region)) found.push_back(*c);
    // Whole spheres and ellipsoids had their turn, and some of them were withdrawn.
    if (const auto c = fit_quadric(region); c && c->type != QuadricType::sphere) found.push_back(*c);
    return found;
  }

  /// Shells that lie in each other's tolerance, whether proven or not, are left as they are; so are those found before,
  /// all of which are whole.
  void withdraw_doubled(std::vector<std::optional<Verdict>>& verdicts) {
    std::vector<Affine> shells;
    for (const Found& f : found_) shells.push_back(f.candidate.to_world);
    std::vector<std::size_t> owners;
    for (std::size_t i = 0; i < verdicts.size(); ++i)
      if (verdicts[i]) shells.push_back(verdicts[i]->candidate.to_world), owners.push_back(i);
    const std::vector<bool> twice = doubled(shells, 2 * tolerance_);
    for (std::size_t i = 0; i < owners.size(); ++i)
      if (twice[found_.size() + i]) verdicts[owners[i]].reset();
    std::vector<std::uint32_t> back;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      if (!twice[i]) continue;
      back.insert(back.end(), found_[i].triangles.begin(), found_[i].triangles.end());
      found_[i].triangles.clear();
    }
    std::erase_if(found_, [](const Found& f) { return f.triangles.empty(); });
    give_back(back);
  }

  void give_back(std::span<const std::uint32_t> triangles) {
    waiting_.insert(waiting_.end(), triangles.begin(), triangles.end());
    std::ranges::sort(waiting_);
  }

  /// Moves what is proven from the triangles that wait to the result.
  void take(const Regions& regions, const std::vector<std::optional<Verdict>>& verdicts) {
    for (std::uint32_t i = 0; i < verdicts.size(); ++i) {
      if (!verdicts[i] || !verdicts[i]->residual) continue;
      const auto triangles = regions[i];
      found_.push_back({verdicts[i]->candidate, {triangles.begin(), triangles.end()}, *verdicts[i]->residual});
    }
    std::erase_if(waiting_, [&](std::uint32_t t) {
      const std::uint32_t region = regions.of(t);
      return region != no_id && verdicts[region] && verdicts[region]->residual;
    });
  }

  const Mesh& mesh_;
  double tolerance_;
  std::vector<std::uint32_t> waiting_;      // ascending
  std::vector<std::uint32_t> judged_size_;  // of each triangle, the size of the last patch of it that was judged
  std::vector<Found> found_;
};

}  // namespace

Recognition recognise(const Mesh& mesh, double tolerance, Pieces pieces) {
  check_mesh(mesh, tolerance);
  if (mesh.triangles.size() >= no_id / 3)
    throw Error("a mesh of " + std::to_string(mesh.triangles.size()) +
                " triangles has too many to number its edges: cut it in two");
  return Recogniser(mesh, tolerance).run(pieces);
}

}  // namespace rayengine
