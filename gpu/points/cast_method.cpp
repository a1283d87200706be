#include "gpu/points/cast_method.h"

#include "accel/tracer.h"

namespace rayengine {

void CastMethod::draw_part(const CastView&, PointsCaster::Part) {
  throw Error("only casting by points has parts that can be timed: choose that method");
}

}  // namespace rayengine
