#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/measure/contestant.h"

// Timing contestants on the same rays. Who compares takes turns: one run of each, again and again, so that what the
// machine does meanwhile strikes all of them alike.
namespace rayengine {

struct RaySet {
  std::string name;
  RayClass ray_class;
  bool any;  ///< asked whether, not where
  std::vector<Ray> rays;
};

struct Entry {
  std::unique_ptr<Contestant> contestant;
  std::size_t rays = 0;       ///< in one run
  std::vector<double> rates;  ///< Mrays/s of the runs
};

inline constexpr int timed_runs = 9;             ///< after one to warm up
inline constexpr std::size_t probe_rays = 4096;  ///< that tell how slow one is

/// Seconds for one query of the first `count` rays, on poisoned buffers.
double run_seconds(Contestant& contestant, const RaySet& set, std::size_t count);

/// Runs once untimed, forgets earlier rates, and cuts the rays of slow contestants so that a run stays short.
void warm_up(Entry& entry, const RaySet& set);

/// One timed run, on poisoned buffers.
void time_run(Entry& entry, const RaySet& set);

/// Linear between neighbours; needs a sorted range that is not empty.
double quantile(const std::vector<double>& sorted, double q);

}  // namespace rayengine
