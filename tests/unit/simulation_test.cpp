#include "engine/schedule/simulation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/schedule/simulated_cases.h"

namespace rayengine {
namespace {

std::string label(const SimulatedCase& c) {
  return c.group + " " + c.name + " ratio " + std::to_string(c.ratio) + " latency " + std::to_string(c.latency) +
         " rays " + std::to_string(c.rays);
}

std::vector<SimulatedRow> rows_of(const std::string& group) {
  std::vector<SimulatedRow> rows;
  for (const SimulatedCase& c : simulated_cases())
    if (c.group == group) rows.push_back(run_simulated(c));
  return rows;
}

/// A thousandth is the luck of noisy batches: at 1:1 an even split is the best there is.
void expect_ahead(const SimulatedRow& row) {
  for (const double other : {row.even, row.cycles, row.fewest})
    EXPECT_GE(row.ours, 0.999 * other) << label(row.subject);
}

/// The goals: 0.95 of the oracle's rate at 10 million rays and 0.85 from the first million.
void expect_close(const std::string& group) {
  const auto rows = rows_of(group);
  ASSERT_EQ(rows.size(), 90u);
  for (const SimulatedRow& row : rows) {
    EXPECT_GE(row.ours, row.subject.rays >= 10'000'000 ? 0.95 : 0.85) << label(row.subject);
    expect_ahead(row);
  }
}

TEST(Simulation, ComesCloseToTheOracleAtEveryRateAndLatency) { expect_close("rates"); }

TEST(Simulation, PaysForSendingAndComesClose) { expect_close("walk"); }

TEST(Simulation, LosesLittleToFaults) {
  for (const SimulatedRow& row : rows_of("faults")) {
    EXPECT_GE(row.ours, 0.90) << label(row.subject);
    expect_ahead(row);
  }
}

MadeMachine with_gpu(const MadeGpu& gpu) { return {.threads = 2, .per_ray = 2e-7, .gpus = {gpu}}; }

TEST(Simulation, TheOracleAddsRates) {
  EXPECT_NEAR(oracle_bound(with_gpu({.per_ray = 5e-8}), 3'000'000), 0.1, 1e-6);
  EXPECT_NEAR(oracle_bound(with_gpu({.latency = 1e-2, .per_ray = 1e-7}), 1'000'000), 0.055, 1e-6);
  // Sending costs more than tracing: nothing is sent.
  EXPECT_NEAR(oracle_bound(with_gpu({.per_ray = 1e-9, .walk = 3e-7}), 1'000'000), 0.1, 1e-6);
}

TEST(Simulation, TheOracleKnowsWhenADeviceStops) {
  MadeGpu gpu{.per_ray = 1e-7};
  gpu.speed = {{0.01, 0}};
  EXPECT_NEAR(oracle_bound(with_gpu(gpu), 1'000'000), 0.09, 1e-6);
}

TEST(Simulation, NothingBeatsTheOracleWithoutNoise) {
  for (const double ratio : {0.1, 1.0, 30.0})
    for (const double latency : {0.0, 1e-3}) {
      const MadeMachine machine = with_gpu({.latency = latency, .per_ray = 1e-7 / ratio});
      const double bound = oracle_bound(machine, 1'000'000);
      EXPECT_GE(simulate(machine, 1'000'000).seconds, bound);
      EXPECT_GE(simulate_even_split(machine, 1'000'000), bound * (1 - 1e-9));
      EXPECT_GE(simulate_cycles(machine, 1'000'000), bound * (1 - 1e-9));
      EXPECT_GE(simulate_fewest_pending(machine, 1'000'000), bound * (1 - 1e-9));
    }
}

TEST(Simulation, AQueueWorksThroughAStall) {
  MadeQueue queue(0, 1e-6, 0, {{0.5, 0}, {1.5, 1}}, 1);
  EXPECT_NEAR(queue.done(0, 1'000'000), 2, 1e-9);
  EXPECT_NEAR(queue.done(0, 1'000'000), 3, 1e-9);
  MadeQueue dead(0, 1e-6, 0, {{0.5, 0}}, 1);
  EXPECT_TRUE(std::isinf(dead.done(0, 1'000'000)));
}

TEST(Simulation, OthersLosePoolsToDevicesThatBreak) {
  MadeGpu gpu{.per_ray = 1e-8};
  gpu.breaks = 0.01;
  EXPECT_TRUE(std::isinf(simulate_even_split(with_gpu(gpu), 10'000'000)));
  EXPECT_TRUE(std::isinf(simulate_cycles(with_gpu(gpu), 10'000'000)));
  EXPECT_LT(simulate(with_gpu(gpu), 10'000'000).seconds, 1.0);
}

TEST(Simulation, IsTheSameForTheSameSeed) {
  const MadeMachine machine = with_gpu({.latency = 1e-3, .per_ray = 3e-8, .noise = 0.1});
  EXPECT_EQ(simulate(machine, 1'000'000, 7).seconds, simulate(machine, 1'000'000, 7).seconds);
  EXPECT_NE(simulate(machine, 1'000'000, 7).seconds, simulate(machine, 1'000'000, 8).seconds);
}

}  // namespace
}  // namespace rayengine
