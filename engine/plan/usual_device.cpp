#include "engine/plan/device.h"

namespace rayengine {
namespace {

// What `rayengine plan --measure` wrote on the machine of docs/performance.md.
constexpr const char* measured = R"(rayengine-device-3
8.16e-08 5.49e-07 2.31e-08
embree fast thorough 0 0 5.96e-08 5.96e-08
  1.65e-07 70.5 8 128 8192 3.55e-09 3.55e-09 9.26e-09 1.78e-08 3.68e-08 5.27e-08
  3.99e-07 111 8 256 8192 3.24e-09 6.14e-09 2.53e-08 2.19e-08 5.56e-08 1.15e-07
  4.59e-07 107 8 256 8192 3.44e-09 8.96e-09 4.1e-08 2.15e-08 6.13e-08 1.39e-07
embree robust thorough 0 0 5.96e-08 1.11e-16
  1.7e-07 70.5 8 128 8192 4.34e-09 4.34e-09 8.77e-09 2.18e-08 3.87e-08 6.13e-08
  3.37e-07 110 8 256 8192 3.24e-09 6.3e-09 2.88e-08 2.19e-08 5.73e-08 1.23e-07
  4.63e-07 107 8 256 8192 3.69e-09 8.77e-09 4.27e-08 2.26e-08 6.43e-08 1.49e-07
embree robust quick 0 0 5.96e-08 1.11e-16
  4.8e-08 99.5 8 128 8192 4.34e-09 4.34e-09 9.95e-09 2.52e-08 4.1e-08 7.5e-08
  1.92e-07 130 8 256 8192 3.69e-09 6.51e-09 3.06e-08 2.54e-08 5.94e-08 1.24e-07
  8.21e-07 101 8 256 8192 4.28e-09 8.77e-09 4.27e-08 2.38e-08 6.43e-08 1.49e-07
bvh robust thorough 0 0 1.11e-16 1.11e-16
  3.82e-07 140 8 128 8192 5.49e-09 6.93e-09 1.22e-08 2.68e-08 4.15e-08 6.49e-08
  6.85e-07 125 8 256 8192 4.26e-09 7.59e-09 2.62e-08 2.23e-08 5.3e-08 1.18e-07
  6.41e-07 84.4 8 256 8192 1.13e-08 3.5e-08 1.16e-07 5.88e-08 1.79e-07 3.87e-07
bvh robust none 0 0 1.11e-16 1.11e-16
  1.01e-07 86.1 8 32 128 6.89e-09 1.68e-08 5.64e-08 1.73e-08 4.2e-08 1.14e-07
  3.12e-07 21.5 1 8 32 3.91e-09 6.11e-09 1.57e-08 1.09e-08 1.62e-08 3.88e-08
  0 0 0 0 0 0 0 0 0 0 0
bvh certified thorough 0 0 0 0
  3.75e-07 140 8 128 8192 6.71e-09 8e-09 1.39e-08 3.19e-08 4.68e-08 6.84e-08
  7.77e-07 125 8 256 8192 5.11e-09 9.44e-09 2.87e-08 2.4e-08 5.53e-08 1.25e-07
  6.97e-07 84.4 8 256 8192 1.21e-08 3.77e-08 1.21e-07 6.95e-08 1.95e-07 4.02e-07
)";

}  // namespace

const DeviceMeasurements& usual_device() {
  static const DeviceMeasurements device = device_from_text(measured);
  return device;
}

}  // namespace rayengine
