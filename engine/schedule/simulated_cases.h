#pragma once

#include <string>
#include <vector>

#include "engine/schedule/made_machine.h"

namespace rayengine {

/// A made machine and a pool of rays.
struct SimulatedCase {
  std::string group;  ///< "rates", "walk" or "faults"
  std::string name;
  double ratio = 0;    ///< the GPU's rate over the processor's
  double latency = 0;  ///< the GPU's, seconds
  std::size_t rays = 0;
  MadeMachine machine;
};

/// The cases that the policy is held to. `rates`: a GPU of 0.001 to 1000 times the processor's rate with latencies of 0
/// to 10 ms. `walk`: the same where sending a ray costs the processor half of what tracing it does. `faults`: devices
/// that are noisy, slow down, stall, never answer or break, and several GPUs.
std::vector<SimulatedCase> simulated_cases();

/// A case under our policy and others: the oracle's time over theirs, medians over several seeds; 0 where a pool is
/// never done. Above 1 by luck: noise can be kind, and the oracle expects the mean.
struct SimulatedRow {
  SimulatedCase subject;
  double bound_seconds = 0;
  double ours = 0, even = 0, cycles = 0, fewest = 0;
  double gpu_share = 0, traced_twice = 0;  ///< of the rays, under ours
};

SimulatedRow run_simulated(const SimulatedCase& subject);

}  // namespace rayengine
