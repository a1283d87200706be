#include "engine/schedule/simulated_cases.h"

#include <algorithm>
#include <array>

#include "engine/schedule/simulation.h"

namespace rayengine {
namespace {

constexpr double per_ray = 1e-7;  // of the made processor, all threads together
constexpr double noise = 0.05;
constexpr std::array ratios = {0.001, 0.01, 0.1, 0.3, 1.0, 3.0, 10.0, 100.0, 1000.0};
constexpr std::array latencies = {0.0, 1e-4, 1e-3, 3e-3, 1e-2};
constexpr std::array<std::size_t, 2> pools = {1'000'000, 10'000'000};
constexpr std::uint64_t seeds = 25;

MadeGpu gpu(double ratio, double latency) { return {.latency = latency, .per_ray = per_ray / ratio, .noise = noise}; }

SimulatedCase make(std::string group, std::string name, double ratio, double latency, std::size_t rays,
                   std::vector<MadeGpu> gpus) {
  return {std::move(group),
          std::move(name),
          ratio,
          latency,
          rays,
          {.threads = 2, .per_ray = 2 * per_ray, .noise = noise, .gpus = std::move(gpus)}};
}

void add_grid(std::vector<SimulatedCase>& cases, const char* group, double walk) {
  for (const std::size_t rays : pools)
    for (const double latency : latencies)
      for (const double ratio : ratios) {
        MadeGpu g = gpu(ratio, latency);
        g.walk = walk;
        cases.push_back(make(group, "", ratio, latency, rays, {g}));
      }
}

/// One GPU, three times as fast as the processor, to which something happens.
void add_fault(std::vector<SimulatedCase>& cases, const char* name, double noisy, std::vector<SpeedChange> speed,
               double breaks = forever) {
  MadeGpu g = gpu(3, 1e-3);
  g.noise = noisy, g.speed = std::move(speed), g.breaks = breaks;
  cases.push_back(make("faults", name, 3, 1e-3, pools.back(), {g}));
}

template <class Run>
double efficiency(double bound, const Run& run) {
  std::array<double, seeds> seconds;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) seconds[seed] = run(seed + 1);
  std::ranges::sort(seconds);
  return bound / seconds[seeds / 2];
}

}  // namespace

std::vector<SimulatedCase> simulated_cases() {
  std::vector<SimulatedCase> cases;
  add_grid(cases, "rates", 0);
  add_grid(cases, "walk", per_ray);
  add_fault(cases, "noise of 30 %", 0.3, {});
  add_fault(cases, "100 times slower from 50 ms on", noise, {{0.05, 0.01}});
  add_fault(cases, "slower by and by", noise, {{0.05, 0.5}, {0.1, 0.25}, {0.15, 0.125}});
  add_fault(cases, "stall of 50 ms", noise, {{0.05, 0}, {0.1, 1}});
  add_fault(cases, "stall of 5 s", noise, {{0.05, 0}, {5.05, 1}});
  add_fault(cases, "never answers", noise, {{0, 0}});
  add_fault(cases, "breaks after 50 ms", noise, {}, 0.05);
  cases.push_back(make("faults", "GPUs of 3 and 10", 13, 1e-3, pools.back(), {gpu(3, 1e-3), gpu(10, 1e-3)}));
  cases.push_back(make("faults", "four GPUs of 0.1 to 10", 14.1, 1e-3, pools.back(),
                       {gpu(0.1, 0), gpu(1, 1e-3), gpu(3, 3e-3), gpu(10, 1e-3)}));
  return cases;
}

SimulatedRow run_simulated(const SimulatedCase& c) {
  SimulatedRow row{c, oracle_bound(c.machine, c.rays)};
  const auto rate = [&](auto&& seconds) { return efficiency(row.bound_seconds, seconds); };
  row.ours = rate([&](std::uint64_t seed) { return simulate(c.machine, c.rays, seed).seconds; });
  row.even = rate([&](std::uint64_t seed) { return simulate_even_split(c.machine, c.rays, seed); });
  row.cycles = rate([&](std::uint64_t seed) { return simulate_cycles(c.machine, c.rays, seed); });
  row.fewest = rate([&](std::uint64_t seed) { return simulate_fewest_pending(c.machine, c.rays, seed); });
  const Outcome outcome = simulate(c.machine, c.rays);
  row.gpu_share = outcome.gpu_share, row.traced_twice = outcome.traced_twice;
  return row;
}

}  // namespace rayengine
