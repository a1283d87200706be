#pragma once

#include <memory>
#include <string>
#include <vector>

#include "accel/geometry.h"
#include "accel/tracer.h"

namespace rayengine {

struct StreamOptions {
  int device = -1;                   ///< an EGL device by its number; the best when negative
  std::uint32_t treelet_size = 0;    ///< primitives that a treelet holds at most; 0 for what suits the device
  std::uint32_t list_length = 0;     ///< treelets that a ray takes along at once, up to 4; 0 for what suits the device
  int batch_side = 0;                ///< a batch holds side x side rays; 0 for what suits the device
  int in_flight = 3;                 ///< batches on the device at once
  std::vector<std::string> defines;  ///< added to the kernels: how tests break one to see that it is noticed
};

/// The ray engine. Source: Carr, Hall, Hart, "The Ray Engine" (2002), in the stream model of Purcell et al. (2002). The
/// CPU walks a BVH and lists each ray's treelets front to back; shaders test the rays against what the treelets hold.
///
/// Holds `fast` (single precision as it comes) and `robust` (shifted quadratic and watertight triangles in single
/// precision; each hit is then worked out, and checked, in double on the CPU). Instances are copied. Calls may come
/// from any thread, one at a time; they are served by a thread that owns the OpenGL context. Throws Error without a
/// GPU, or when the scene is too large for it.
std::unique_ptr<Tracer> make_stream_tracer(std::shared_ptr<const Geometry> geometry, Precision precision,
                                           const StreamOptions& options = {});

}  // namespace rayengine
