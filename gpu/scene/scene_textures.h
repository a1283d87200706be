#pragma once

#include <vector>

#include "accel/treelets.h"
#include "gpu/device/context.h"
#include "gpu/device/objects.h"
#include "gpu/scene/flat_scene.h"

namespace rayengine {

/// A kind of primitive that has an intersection shader of its own, and what those of the scene need of it.
struct KernelType {
  std::uint32_t primitive;  ///< TreeletPrimitive::triangle, or a QuadricType
  bool clipped;             ///< whether any of these quadrics may be, by planes across z
  bool capped;
  bool balls;  ///< whether all of them are is_ball()

  KernelType(std::uint32_t primitive, bool clipped = true, bool capped = true, bool balls = false)
      : primitive(primitive), clipped(clipped), capped(capped), balls(balls) {}
  friend bool operator==(const KernelType& type, std::uint32_t primitive) { return type.primitive == primitive; }
};

/// Primitives that one loop of a shader may test: llvmpipe ends every loop after 65,535 rounds.
inline constexpr std::uint32_t longest_loop = 1u << 15;

/// The texture units of the primitives.
enum PrimitiveUnit : GLuint { triangles_unit = 6, forms_unit = 7, quadrics_unit = 8 };

/// The primitives of a scene on the device, in the order of its treelets and in the coordinates of their frame. What
/// the texels mean is said in gpu/shaders/stream.
struct SceneTextures {
  std::vector<KernelType> types;  ///< those that occur, in the order in which a treelet's are tested
  BufferTexture triangles, quadrics, forms;
  BufferTexture ranges;  ///< of treelets: see upload_ranges
  std::size_t bytes = 0;

  void bind() const;
};

/// Throws Error when the scene is larger than the device's buffer textures.
SceneTextures upload(const FlatScene& scene, const Treelets& treelets, const GpuInfo& gpu);

/// The primitives alone, in the order of the geometry.
SceneTextures upload(const FlatScene& scene, const LocalFrame& frame, const GpuInfo& gpu);

/// For every type of every treelet, then of those without bounds, then of none: its first primitive among those of all
/// treelets (triangles and quadrics are counted apart), and how many.
BufferTexture upload_ranges(const Geometry& geometry, const Treelets& treelets, const std::vector<KernelType>& types,
                            const GpuInfo& gpu);

/// Throws Error, with the number and the limit, when a buffer texture cannot hold so many texels.
void require_texels(std::size_t texels, const char* what, const GpuInfo& gpu);

/// The number that lists use for the primitives that no box holds.
inline std::uint32_t unbounded_treelet(const Treelets& treelets) {
  return static_cast<std::uint32_t>(treelets.treelets.size());
}
/// The number of a treelet that holds nothing.
inline std::uint32_t empty_treelet(const Treelets& treelets) { return unbounded_treelet(treelets) + 1; }

}  // namespace rayengine
