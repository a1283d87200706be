#include "gpu/points/points_tracer.h"

#include "gpu/gpu_tracer.h"
#include "gpu/points/points_engine.h"

namespace rayengine {

std::unique_ptr<Tracer> make_points_tracer(std::shared_ptr<const Geometry> geometry, Precision precision,
                                           const PointsTracerOptions& options) {
  return make_gpu_tracer("points", geometry, precision,
                         [&] { return std::make_unique<PointsEngine>(geometry, options); });
}

}  // namespace rayengine
