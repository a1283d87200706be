#include "gpu/device/await.h"

#include "accel/tracer.h"

namespace rayengine {
namespace {

constexpr std::uint64_t patience = 60'000'000'000;  // nanoseconds

}  // namespace

void await(const Fence& fence, Context& context) {
  const bool reached = fence.reached(patience);
  context.check_errors("tracing");
  if (!reached)
    throw Error("the GPU (" + context.info().renderer + ") has not answered for a minute; use --tracer embree");
}

}  // namespace rayengine
