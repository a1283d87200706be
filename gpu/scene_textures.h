#pragma once

#include <vector>

#include "accel/treelets.h"
#include "gpu/context.h"
#include "gpu/flat_scene.h"
#include "gpu/objects.h"

namespace rayengine {

/// A kind of primitive that has an intersection shader of its own: TreeletPrimitive::triangle, or a QuadricType.
using KernelType = std::uint32_t;

/// Primitives that one loop of a shader may test: llvmpipe ends every loop after 65,535 rounds.
inline constexpr std::uint32_t longest_loop = 1u << 15;

/// The primitives of a scene on the device, in the order of its treelets and in the coordinates of their frame. What
/// the texels mean is said in gpu/shaders/stream.
struct SceneTextures {
  std::vector<KernelType> types;  ///< those that occur, in the order in which a treelet's are tested
  BufferTexture triangles, quadrics, forms, ranges;
  std::size_t bytes = 0;
};

/// Throws Error when the scene is larger than the device's buffer textures.
SceneTextures upload(const FlatScene& scene, const Treelets& treelets, const GpuInfo& gpu);

/// The number that lists use for the primitives that no box holds.
inline std::uint32_t unbounded_treelet(const Treelets& treelets) {
  return static_cast<std::uint32_t>(treelets.treelets.size());
}
/// The number of a treelet that holds nothing.
inline std::uint32_t empty_treelet(const Treelets& treelets) { return unbounded_treelet(treelets) + 1; }

}  // namespace rayengine
