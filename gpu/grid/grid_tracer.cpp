#include "gpu/grid/grid_tracer.h"

#include "gpu/gpu_tracer.h"
#include "gpu/grid/grid_engine.h"

namespace rayengine {

std::unique_ptr<Tracer> make_grid_tracer(std::shared_ptr<const Geometry> geometry, Precision precision,
                                         const GridTracerOptions& options) {
  return make_gpu_tracer("grid", geometry, precision, [&] { return std::make_unique<GridEngine>(geometry, options); });
}

}  // namespace rayengine
