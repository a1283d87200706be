#include "gpu/cast_watch.h"

#include <epoxy/gl.h>

#include "accel/stopwatch.h"

namespace rayengine {
namespace {

CastSeconds now() {
  static const Stopwatch watch;
  glFinish();
  return {watch.seconds(), processor_seconds()};
}

}  // namespace

void CastWatch::start() { started_ = now(); }

void CastWatch::stop(double times) {
  const CastSeconds stopped = now();
  seconds_.elapsed += times * (stopped.elapsed - started_.elapsed);
  seconds_.processor += times * (stopped.processor - started_.processor);
}

}  // namespace rayengine
