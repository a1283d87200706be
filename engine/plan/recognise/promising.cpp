#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "engine/plan/recognise/cloud.h"
#include "engine/plan/recognise/neighbourhood.h"
#include "engine/plan/recognise/recognise.h"
#include "engine/plan/recognise/symmetric.h"

namespace rayengine {
namespace {

using namespace surfaces;

/// What is looked at: so many runs of so many triangles that follow each other in the mesh, evenly spread, and in each
/// the surroundings of some triangles.
constexpr std::size_t runs = 48, run_length = 128, seeds = 4, patch_size = 24;

/// The root mean square, over the corners of a patch on a quadric, of the form of size 1 that is least there; about
/// what six digits in print leave.
constexpr double noise = 1e-6;

/// Patches in so many, one of which must be on a quadric.
constexpr std::size_t one_in = 32;

/// A run of triangles with vertices of its own.
struct Piece {
  std::vector<glm::dvec3> positions;
  std::vector<glm::uvec3> triangles;

  Piece(const Mesh& mesh, std::size_t first, std::size_t count) {
    for (std::size_t t = first; t < first + count; ++t) {
      const auto at = static_cast<std::uint32_t>(positions.size());
      for (int k = 0; k < 3; ++k) positions.push_back(mesh.positions[mesh.triangles[t][k]]);
      triangles.push_back({at, at + 1, at + 2});
    }
  }
};

bool is_on_quadric(const Patch& patch) {
  const Cloud cloud(patch);
  if (!cloud.usable()) return false;
  Matrix<10> m{};
  each_corner(patch, [&](const glm::dvec3& at) { add_outer<10>(m, monomials(cloud.local(at))); });
  return eigen(m).values[0] < noise * noise * 3 * static_cast<double>(patch.triangles.size());
}

struct Tally {
  std::size_t patches = 0, good = 0;
};

void look_at(const Piece& piece, Tally& tally) {
  std::vector<std::uint32_t> all(piece.triangles.size());
  std::iota(all.begin(), all.end(), 0u);
  const std::vector<glm::uvec3> welded = weld(piece.positions, piece.triangles, all);
  Topology mesh{piece.positions, welded, find_twins(welded, all, piece.positions.size()), {}};
  for (const glm::uvec3& t : welded) mesh.normals.push_back(normal(mesh, t));
  for (std::size_t i = 0; i < seeds; ++i) {
    const auto seed = static_cast<std::uint32_t>((2 * i + 1) * all.size() / (2 * seeds));
    const auto patch = neighbourhood(mesh, seed, patch_size, [](std::uint32_t) { return true; });
    if (patch.size() < fewest_triangles) continue;
    ++tally.patches;
    tally.good += is_on_quadric({mesh, patch});
  }
}

}  // namespace

bool may_hold_quadrics(const Mesh& mesh) {
  const std::size_t count = mesh.triangles.size();
  if (count < fewest_triangles) return false;
  Tally tally;
  const std::size_t length = std::min(run_length, count), places = std::min(runs, (count + length - 1) / length);
  for (std::size_t i = 0; i < places; ++i)
    look_at(Piece(mesh, places > 1 ? i * (count - length) / (places - 1) : 0, length), tally);
  return tally.good * one_in >= std::max<std::size_t>(tally.patches, 1);
}

}  // namespace rayengine
