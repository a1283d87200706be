#pragma once

#include <memory>

#include "accel/geometry.h"
#include "accel/tracer.h"

namespace rayengine {

struct ConesOptions {
  int device = -1;  ///< an EGL device by its number; the best when negative
  int tile = 16;    ///< a tile holds tile x tile rays, 1 to 256
};

/// The hierarchical ray engine. Source: Szecsi, "The Hierarchical Ray Engine" (WSCG 2006). Rays lie in tiles; the
/// device builds a cone around each tile's rays, and draws each primitive over each tile as a point, which the vertex
/// shader drops where the cone passes the primitive's enclosing sphere; fragments do the test of ray and primitive, and
/// the depth test keeps the nearest hit. No structure over the scene: time goes with tiles times primitives, for
/// coherent rays with a small factor.
///
/// Holds `fast` and `robust`, both as `stream` does. What has no end is tested against every ray. Throws as
/// make_stream_tracer, and when the device draws no points as large as a tile.
std::unique_ptr<Tracer> make_cones_tracer(std::shared_ptr<const Geometry> geometry, Precision precision,
                                          const ConesOptions& options = {});

}  // namespace rayengine
