#pragma once

#include <cstdint>

#include "engine/schedule/made_machine.h"

namespace rayengine {

/// What became of a pool of rays.
struct Outcome {
  double seconds = 0;       ///< until the last was answered
  double gpu_share = 0;     ///< of the rays, those that GPUs answered
  double traced_twice = 0;  ///< rays traced by the processor that a GPU had, over all rays
};

/// Runs our policy (policy.h) on a made machine, from knowing nothing: a discrete-event simulation.
Outcome simulate(const MadeMachine& machine, std::size_t rays, std::uint64_t seed = 1);

// The same under what others do, as docs/scheduler.md describes it; seconds, infinite when a device takes its rays with
// it.

/// Everybody gets as many rays.
double simulate_even_split(const MadeMachine& machine, std::size_t rays, std::uint64_t seed = 1);
/// Cycles: ten passes over a picture of 1080 rows, with shares of rows corrected after each; all wait for the last.
double simulate_cycles(const MadeMachine& machine, std::size_t rays, std::uint64_t seed = 1);
/// LuxCore's virtual device: buffers of 65,536 rays to whom fewest are pending, collected in the order of handing out.
double simulate_fewest_pending(const MadeMachine& machine, std::size_t rays, std::uint64_t seed = 1);

}  // namespace rayengine
