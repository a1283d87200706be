#pragma once

#include <vector>

#include "gpu/device/context.h"
#include "gpu/scene/flat_scene.h"
#include "gpu/scene/scene_textures.h"

namespace rayengine {

/// The primitives of a scene as cones are held against them: by type, each type's by falling rank, those that have an
/// end before those that have none.
struct ConesScene {
  /// The primitives of one type: textures.types[type].
  struct Run {
    std::size_t type;
    std::uint32_t first, count;
    std::uint32_t first_sphere = 0;  ///< of all primitives of such texels
  };

  ConesScene(std::shared_ptr<const Geometry> geometry, const GpuInfo& gpu);

  bool is_triangle(const Run& run) const { return textures.types[run.type] == TreeletPrimitive::triangle; }
  std::size_t bytes() const { return textures.bytes + spheres.buffer.bytes; }

  FlatScene flat;
  Treelets list;  ///< all primitives, in no structure
  SceneTextures textures;
  std::vector<Run> bounded, unbounded;
  BufferTexture spheres;  ///< centre and radius of each primitive, in the frame: triangles, then quadrics
};

}  // namespace rayengine
