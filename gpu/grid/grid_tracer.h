#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "accel/geometry.h"
#include "accel/grid.h"
#include "accel/tracer.h"
#include "gpu/grid/grid_policy.h"

namespace rayengine {

struct GridTracerOptions {
  int device = -1;  ///< an EGL device by its number; the best when negative
  GridOptions grid;
  /// None for what suits the device: hardware ends the last half of a batch in a loop; to a renderer in software, which
  /// pays for each pass, all of it is left.
  std::optional<GridPolicy> policy;
  int batch_side = 0;                ///< a batch holds side x side rays; 0 for what suits the device
  std::vector<std::string> defines;  ///< added to the kernels: how tests break one to see that it is noticed
};

/// The stream ray tracer of Purcell, Buck, Mark and Hanrahan, "Ray Tracing on Programmable Graphics Hardware" (2002):
/// the whole scene is in a uniform grid in textures, and rays are moved through it, and tested against what voxels
/// list, by fragment programs; each ray's state is a depth, and the CPU only chooses which kernel runs next.
///
/// Holds `fast` and `robust`, both as `stream` does; instances are copied. Throws as make_stream_tracer, and when the
/// grid's lists are too long.
std::unique_ptr<Tracer> make_grid_tracer(std::shared_ptr<const Geometry> geometry, Precision precision,
                                         const GridTracerOptions& options = {});

}  // namespace rayengine
