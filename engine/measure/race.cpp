#include "engine/measure/race.h"

#include <algorithm>

#include "accel/stopwatch.h"

namespace rayengine {
namespace {

constexpr double longest_run = 4;  // seconds; slower ones get fewer rays

/// The best of a few short runs: the first ones pay for memory and caches.
double probe_seconds(Contestant& contestant, const RaySet& set, std::size_t probe) {
  double seconds = infinity;
  for (int run = 0; run < 3; ++run) seconds = std::min(seconds, run_seconds(contestant, set, probe));
  return std::max(seconds, 1e-9);
}

}  // namespace

double run_seconds(Contestant& contestant, const RaySet& set, std::size_t count) {
  const auto rays = std::span(set.rays).first(count);
  contestant.poison(count);
  const Stopwatch watch;
  set.any ? contestant.any(rays, set.ray_class) : contestant.closest(rays, set.ray_class);
  return watch.seconds();
}

void warm_up(Entry& entry, const RaySet& set) {
  const std::size_t probe = std::min(probe_rays, set.rays.size());
  const double affordable = longest_run * static_cast<double>(probe) / probe_seconds(*entry.contestant, set, probe);
  const bool slow = affordable < static_cast<double>(set.rays.size());
  entry.rays = slow ? std::max(probe, static_cast<std::size_t>(affordable)) : set.rays.size();
  entry.rates.clear();
  run_seconds(*entry.contestant, set, entry.rays);
}

void time_run(Entry& entry, const RaySet& set) {
  const double seconds = run_seconds(*entry.contestant, set, entry.rays);
  entry.rates.push_back(static_cast<double>(entry.rays) / seconds / 1e6);
}

double quantile(const std::vector<double>& sorted, double q) {
  const double at = q * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace rayengine
