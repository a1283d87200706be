#include "engine/plan/device.h"

namespace rayengine {
namespace {

// What `rayengine plan --measure` wrote on the machine of docs/performance.md.
constexpr const char* measured = R"(rayengine-device-2
8.16e-08 5.49e-07 2.31e-08
embree fast thorough 5.96e-08 5.96e-08 1.33e-07 70.3 0 1.66e-09 8.69e-09 3.36e-09 6.8e-07 82.4 0 7.01e-09 0 1.67e-08
embree robust thorough 5.96e-08 1.11e-16 1.19e-07 70.3 0 1.46e-09 4.83e-09 3.94e-09 2.85e-07 82.4 0 7.43e-09 0 1.55e-08
embree robust quick 5.96e-08 1.11e-16 3.81e-08 91.7 0 1.93e-09 8.97e-10 4.98e-09 2.1e-07 89.3 0 7.41e-09 0 1.41e-08
bvh robust thorough 1.11e-16 1.11e-16 5.18e-07 140 6.66e-10 2.48e-09 0 7.37e-09 8.37e-07 125 0 7.28e-09 0 1.66e-08
bvh certified thorough 0 0 4.41e-07 140 3.68e-09 2.03e-09 8.01e-09 5.26e-09 8.49e-07 125 0 8.39e-09 0 2.3e-08
)";

}  // namespace

const DeviceMeasurements& usual_device() {
  static const DeviceMeasurements device = device_from_text(measured);
  return device;
}

}  // namespace rayengine
