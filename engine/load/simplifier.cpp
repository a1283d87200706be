#include "engine/load/simplifier.h"

#include "engine/load/mesh_cache.h"

namespace rayengine {

Simplifier cached_simplifier() {
  return {[](const Mesh& mesh, double distance) { return simplify_cached(mesh, distance); },
          [](const Mesh& mesh, double distance) { return find_simplified(mesh, distance); }, may_have_simplified};
}

}  // namespace rayengine
