#include "gpu/stream/stream_tracer.h"

#include "gpu/gpu_tracer.h"
#include "gpu/stream/stream_engine.h"

namespace rayengine {

std::unique_ptr<Tracer> make_stream_tracer(std::shared_ptr<const Geometry> geometry, Precision precision,
                                           const StreamOptions& options) {
  return make_gpu_tracer("stream", geometry, precision,
                         [&] { return std::make_unique<StreamEngine>(geometry, options); });
}

}  // namespace rayengine
