#include "engine/load/mesh_tools.h"

#include "engine/load/mesh_cache.h"
#include "engine/load/mesh_files.h"
#include "engine/load/recognition_cache.h"

namespace rayengine {

MeshTools cached_mesh_tools() {
  return {.simplify = [](const Mesh& mesh, double distance) { return simplify_cached(mesh, distance); },
          .recall_simplified = [](const Mesh& mesh, double distance) { return find_simplified(mesh, distance); },
          .recognise = recognise_cached,
          .recall_recognised = find_recognised,
          .may_recall = may_have_mesh_file};
}

}  // namespace rayengine
