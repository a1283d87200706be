#pragma once

namespace rayengine {

/// What a machine pays for a ray. Seconds.
struct RayCosts {
  double walk = 0;     ///< processor time of one thread to have the GPU trace a ray
  double full = 0;     ///< processor time of one thread to trace it whole
  double gpu = 0;      ///< time of the GPU
  double threads = 1;  ///< processor time there is in a second
};

/// Rays a second on both sides.
struct Split {
  double gpu = 0, cpu = 0;
  double total() const { return gpu + cpu; }
};

/// The best that any scheduler can do in the long run: a ray that costs no less to send than to trace is not sent; else
/// the GPU gets what it can answer, or what the processor can send.
Split best_split(const RayCosts& costs);

/// Rays from which on a batch pays: the processor time saved on it is worth more than the latency that nothing hides,
/// `latency` seconds of one thread. Infinite where sending costs as much as tracing.
double break_even(const RayCosts& costs, double latency);

}  // namespace rayengine
