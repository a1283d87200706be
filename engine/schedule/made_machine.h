#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "accel/random.h"
#include "engine/schedule/cost_model.h"

namespace rayengine {

/// From `from` on a device works `factor` times as fast; 0 is a stall.
struct SpeedChange {
  double from = 0, factor = 1;
};

/// A GPU made of numbers: batches pass one after another, and each is under way for `latency` seconds besides.
struct MadeGpu {
  double latency = 0, per_ray = 1e-7;       ///< seconds
  double noise = 0;                         ///< relative standard deviation of a batch's time
  double walk = 0;                          ///< processor time of one thread to send a ray
  std::vector<SpeedChange> speed;           ///< in order
  double breaks = forever;                  ///< from then on every batch comes back with an error
  std::size_t largest = 262144, depth = 3;  ///< rays of a batch, batches at once
};

struct MadeMachine {
  std::size_t threads = 2;
  double per_ray = 2e-7;  ///< seconds of one thread
  double noise = 0;
  std::vector<MadeGpu> gpus;
};

/// The work of a device that does one thing after another.
class MadeQueue {
 public:
  MadeQueue(double latency, double per_ray, double noise, std::vector<SpeedChange> speed, std::uint64_t seed);
  MadeQueue(const MadeGpu& gpu, std::uint64_t seed) : MadeQueue(gpu.latency, gpu.per_ray, gpu.noise, gpu.speed, seed) {}

  /// When `rays` handed over at `now` are done; infinite when never.
  double done(double now, std::size_t rays);
  /// Seconds for `rays` that wait for nothing, at full speed.
  double alone(std::size_t rays);

 private:
  double latency_, per_ray_, noise_;
  std::vector<SpeedChange> speed_;
  Random random_;
  double free_ = 0;
};

/// Seconds below which no schedule can answer `rays` on this machine, noise aside: each device works at its rate from
/// its latency on, as far as the size and number of its batches allow, and the processor's time goes into sending and
/// tracing as is best.
double oracle_bound(const MadeMachine& machine, std::size_t rays);

}  // namespace rayengine
