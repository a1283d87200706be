#include "engine/plan/recognise/recognise.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
#include <string>

#include "accel/tracer.h"
#include "engine/plan/recognise/check.h"
#include "engine/plan/recognise/coincident.h"
#include "engine/plan/recognise/fit.h"
#include "engine/plan/recognise/shape.h"

namespace rayengine {
namespace {

using namespace surfaces;

bool is_finite(const glm::dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

void check_input(const Mesh& mesh, double tolerance) {
  if (!(tolerance > 0 && std::isfinite(tolerance)))
    throw Error("a tolerance of " + std::to_string(tolerance) + " cannot be kept: give one that is finite and above 0");
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    if (!is_finite(mesh.positions[i])) throw Error("vertex " + std::to_string(i) + " of a mesh is not finite");
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if (mesh.triangles[i][k] >= mesh.positions.size())
        throw Error("triangle " + std::to_string(i) + " of a mesh names vertex " +
                    std::to_string(mesh.triangles[i][k]) + ", but there are " + std::to_string(mesh.positions.size()));
}

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

  Recognition run() {
    find_spheres(mesh_.triangles);
    if (!waiting_.empty()) find_spheres(weld(mesh_.positions, mesh_.triangles));
    std::ranges::sort(result_.quadrics, {}, [](const RecognisedQuadric& q) { return q.triangles[0]; });
    result_.rest = std::move(waiting_);
    return std::move(result_);
  }

 private:
  /// Whole connected pieces of the triangles that wait.
  void find_spheres(std::span<const glm::uvec3> triangles) {
    const Topology topology{mesh_.positions, triangles, find_twins(triangles, waiting_, mesh_.positions.size())};
    const Regions pieces = connected(topology, waiting_, [](std::uint32_t) { return true; });
    std::vector<std::optional<Verdict>> verdicts(pieces.size());
    tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t i) {
      verdicts[i] = judge_whole({topology, pieces, static_cast<std::uint32_t>(i)});
    });
    withdraw_coincident(verdicts);
    take(pieces, verdicts);
  }

  std::optional<Verdict> judge_whole(const Region& region) const {
    if (region.triangles().size() < fewest_triangles) return {};
    const std::optional<Candidate> sphere = fit_sphere(region);
    if (!sphere) return {};
    return Verdict{*sphere, proven_residual(region, *sphere, tolerance_)};
  }

  /// Shells that lie in each other's tolerance, whether proven or not, are left as they are.
  void withdraw_coincident(std::vector<std::optional<Verdict>>& verdicts) const {
    std::vector<Round> rounds;
    std::vector<std::size_t> owner;
    for (std::size_t i = 0; i < verdicts.size(); ++i) {
      if (!verdicts[i]) continue;
      rounds.push_back({verdicts[i]->candidate.to_world.origin, lengths(verdicts[i]->candidate.to_world)});
      owner.push_back(i);
    }
    const std::vector<bool> twice = coincident(rounds, 2 * tolerance_);
    for (std::size_t i = 0; i < owner.size(); ++i)
      if (twice[i]) verdicts[owner[i]].reset();
  }

  /// Moves what is proven from the triangles that wait to the result.
  void take(const Regions& regions, const std::vector<std::optional<Verdict>>& verdicts) {
    for (std::uint32_t i = 0; i < verdicts.size(); ++i) {
      if (!verdicts[i] || !verdicts[i]->residual) continue;
      const Candidate& c = verdicts[i]->candidate;
      const auto triangles = regions[i];
      result_.quadrics.push_back(
          {shape_of(c), c.to_world, {triangles.begin(), triangles.end()}, *verdicts[i]->residual});
    }
    std::erase_if(waiting_, [&](std::uint32_t t) {
      const auto& verdict = verdicts[regions.of(t)];
      return verdict && verdict->residual;
    });
  }

  const Mesh& mesh_;
  double tolerance_;
  std::vector<std::uint32_t> waiting_;  // ascending
  Recognition result_;
};

}  // namespace

Recognition recognise(const Mesh& mesh, double tolerance) {
  check_input(mesh, tolerance);
  return Recogniser(mesh, tolerance).run();
}

}  // namespace rayengine
