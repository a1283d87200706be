#pragma once

namespace rayengine {

/// Several hits side by side: a field of theirs.
inline constexpr int surface_batch = 8;
using SurfaceRow = double[surface_batch];

/// Rays, and the surfaces that they meet, as in Surface; `regular` is 0 where that takes what only one by one is done.
struct alignas(64) SurfaceRows {
  SurfaceRow origin[3], direction[3];
  SurfaceRow position[3], normal[3], shading_normal[3], error, magnitude, spread, regular;
};

/// Triangles that are not part of an instance.
struct TriangleBatch : SurfaceRows {
  SurfaceRow corners[3][3], corner_normals[3][3];  ///< by corner and axis
  bool smooth;                                     ///< whether there are normals at the corners
};

/// Sides of unit primitives that are not part of an instance.
struct QuadricBatch : SurfaceRows {
  SurfaceRow form[5];                      ///< as in formulas::Diagonal
  SurfaceRow linear[3][3], map_origin[3];  ///< WorldToObject: by column and row
  SurfaceRow t;                            ///< of the hit
};

/// The solvers of one instruction set. Every lane is computed, whether it holds a hit or not.
struct SurfaceSolvers {
  void (*triangles)(TriangleBatch& batch);
  void (*quadrics)(QuadricBatch& batch);
};

namespace sse2 {
extern const SurfaceSolvers surface_solvers;
}
namespace avx2 {
extern const SurfaceSolvers surface_solvers;
}
namespace avx512 {
extern const SurfaceSolvers surface_solvers;
}

}  // namespace rayengine
