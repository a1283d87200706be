#pragma once

#include <memory>

#include "accel/geometry.h"
#include "accel/tracer.h"

namespace rayengine {

/// The ray caster of Wood, McCane and King, "Ray Tracing Arbitrary Objects on the GPU" (2004): the CPU loops over the
/// objects, and each is one pass in which all rays are taken to its unit primitive; the closest hits so far go from
/// pass to pass in two textures by turns. No structure, so time goes with the product of rays and objects: for small
/// scenes.
///
/// Holds `half` (rays and hits in 16-bit halves, as the paper packs them; no all-hits queries), `fast` and `robust`,
/// both as `stream` does. `device` is an EGL device by its number; the best when negative. Throws as
/// make_stream_tracer.
std::unique_ptr<Tracer> make_objects_tracer(std::shared_ptr<const Geometry> geometry, Precision precision,
                                            int device = -1);

}  // namespace rayengine
