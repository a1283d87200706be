#include "gpu/objects/objects_tracer.h"

#include "gpu/gpu_tracer.h"
#include "gpu/objects/objects_engine.h"

namespace rayengine {

std::unique_ptr<Tracer> make_objects_tracer(std::shared_ptr<const Geometry> geometry, Precision precision, int device) {
  return make_gpu_tracer("objects", geometry, precision,
                         [&] { return std::make_unique<ObjectsEngine>(geometry, precision, device); });
}

}  // namespace rayengine
