#pragma once

#include <memory>

#include "accel/geometry.h"
#include "accel/tracer.h"

namespace rayengine {

struct PointsTracerOptions {
  int device = -1;        ///< an EGL device by its number; the best when negative
  std::size_t batch = 0;  ///< rays that are sent at once, at most; 0 for what suits the device
};

/// Rays as points, after Ralovich and Magdics, "Recursive Ray Tracing in Geometry Shader" (2010): the vertex shader
/// takes each ray of a vertex buffer through the scene's uniform grid, and transform feedback brings the answers back.
/// The paper's whole pipeline, with shading, is PointsCaster.
///
/// Holds `fast` and `robust`, both as `stream` does; instances are copied. Throws as make_grid_tracer.
std::unique_ptr<Tracer> make_points_tracer(std::shared_ptr<const Geometry> geometry, Precision precision,
                                           const PointsTracerOptions& options = {});

}  // namespace rayengine
