#include "engine/plan/device.h"

namespace rayengine {
namespace {

// What `rayengine plan --measure` wrote on the machine of docs/performance.md.
constexpr const char* measured = R"(rayengine-device-1
1.11e-07 1e-06 6e-08
embree fast 5.96e-08 5.96e-08 3.44e-07 67 0 3.56e-09 3.93e-08 5.12e-09 7.36e-07 82.4 0 1.07e-08 0 2.43e-08
embree robust 5.96e-08 1.11e-16 2.62e-07 67 0 3.49e-09 4.35e-08 6.87e-09 5.48e-07 82.4 0 1.3e-08 0 2.67e-08
bvh robust 1.11e-16 1.11e-16 9.08e-07 137 2.97e-08 5.1e-10 2.29e-08 8.21e-09 1.19e-06 125 0 1.48e-08 0 2.99e-08
bvh certified 0 0 4.45e-07 137 1.27e-08 3.86e-09 1.98e-08 9.22e-09 1.03e-06 125 0 1.74e-08 0 2.64e-08
)";

}  // namespace

const DeviceMeasurements& usual_device() {
  static const DeviceMeasurements device = device_from_text(measured);
  return device;
}

}  // namespace rayengine
