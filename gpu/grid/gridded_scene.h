#pragma once

#include "accel/grid.h"
#include "gpu/grid/grid_textures.h"
#include "gpu/scene/flat_scene.h"

namespace rayengine {

/// A scene on the device in its grid, and what the processor must know of it.
struct GriddedScene {
  /// Throws Error when the grid is larger than the device takes.
  GriddedScene(const FlatScene& scene, const Grid& grid, const GpuInfo& gpu)
      : frame(grid.lists.frame),
        first_list(grid.lists.unbounded.size() > 0 ? unbounded_treelet(grid.lists) : no_id),
        textures(scene, grid, gpu) {}

  LocalFrame frame;
  std::uint32_t first_list;  ///< of what has no bounds; no_id when everything has
  GridTextures textures;
};

}  // namespace rayengine
