#include "engine/load/simplifier.h"

#include "engine/load/mesh_cache.h"

namespace rayengine {
namespace {

CoarserMesh as_coarser(Simplified&& s) { return {std::move(s.mesh), s.distance}; }

std::optional<CoarserMesh> recall(const Mesh& mesh, double distance) {
  if (auto found = find_simplified(mesh, distance)) return as_coarser(std::move(*found));
  return {};
}

}  // namespace

Simplifier cached_simplifier() {
  return {[](const Mesh& mesh, double distance) { return as_coarser(simplify_cached(mesh, distance)); }, recall,
          may_have_simplified};
}

}  // namespace rayengine
