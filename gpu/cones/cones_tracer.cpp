#include "gpu/cones/cones_tracer.h"

#include "gpu/cones/cones_engine.h"
#include "gpu/gpu_tracer.h"

namespace rayengine {

std::unique_ptr<Tracer> make_cones_tracer(std::shared_ptr<const Geometry> geometry, Precision precision,
                                          const ConesOptions& options) {
  return make_gpu_tracer("cones", geometry, precision,
                         [&] { return std::make_unique<ConesEngine>(geometry, options); });
}

}  // namespace rayengine
