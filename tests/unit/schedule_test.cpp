#include <gtest/gtest.h>

#include <cmath>

#include "engine/schedule/gpu_trial.h"
#include "engine/schedule/policy.h"
#include "engine/schedule/split.h"

namespace rayengine {
namespace {

CostModel fitted(double latency, double per_ray) {
  CostModel model;
  for (const std::size_t rays : {1000, 20000, 5000, 100000})
    model.add(rays, latency + per_ray * static_cast<double>(rays));
  return model;
}

Crew crew_of(double per_ray, std::size_t threads) {
  Crew crew;
  crew.model = fitted(0, per_ray), crew.threads = threads;
  return crew;
}

Lane lane_of(double latency, double per_ray, double walk = 0) {
  Lane lane;
  lane.model = fitted(latency, per_ray), lane.walk = walk;
  return lane;
}

TEST(CostModel, FindsLatencyAndRate) {
  const CostModel model = fitted(2e-3, 3e-8);
  EXPECT_NEAR(model.latency(), 2e-3, 1e-9);
  EXPECT_NEAR(model.per_ray(), 3e-8, 1e-14);
  EXPECT_NEAR(model.predict(50000), 3.5e-3, 1e-8);
  EXPECT_LT(model.spread(), 0.2);
}

TEST(CostModel, FindsLatencyFromABatchThatWaited) {
  CostModel model;
  model.add(10000, 11e-3);
  EXPECT_EQ(model.latency(), 0);  // one batch says nothing of it
  EXPECT_NEAR(model.predict(10000), 11e-3, 1e-12);
  model.add(10000, 1e-3, true);
  EXPECT_NEAR(model.latency(), 10e-3, 1e-9);
  EXPECT_NEAR(model.per_ray(), 1e-7, 1e-13);
}

TEST(CostModel, FollowsADeviceThatSlowsDown) {
  CostModel model = fitted(1e-3, 1e-8);
  for (int i = 0; i < 6; ++i) model.add(50000, 100 * 1.5e-3);
  EXPECT_GT(model.predict(50000), 0.1);
  EXPECT_GT(model.spread(), 0.3);
}

TEST(CostModel, IsNeverNegative) {
  CostModel model;
  model.add(1000, 5e-3);
  model.add(100000, 1e-3);
  EXPECT_GE(model.latency(), 0);
  EXPECT_GT(model.per_ray(), 0);
}

TEST(Split, SendsNothingThatCostsAsMuchAsTracing) {
  const Split split = best_split({.walk = 1e-7, .full = 1e-7, .gpu = 1e-9, .threads = 4});
  EXPECT_EQ(split.gpu, 0);
  EXPECT_NEAR(split.cpu, 4e7, 1);
  EXPECT_TRUE(std::isinf(break_even({.walk = 1e-7, .full = 1e-7}, 1e-3)));
}

TEST(Split, IsBoundedByTheGpuOrByTheSending) {
  const Split gpu_bound = best_split({.walk = 2e-8, .full = 1e-7, .gpu = 1e-7, .threads = 2});
  EXPECT_NEAR(gpu_bound.gpu, 1e7, 1);
  EXPECT_NEAR(gpu_bound.cpu, (2 - 0.2) / 1e-7, 1);
  const Split walk_bound = best_split({.walk = 5e-8, .full = 1e-7, .gpu = 1e-10, .threads = 2});
  EXPECT_NEAR(walk_bound.gpu, 4e7, 1);
  EXPECT_NEAR(walk_bound.cpu, 0, 1);
  EXPECT_NEAR(break_even({.walk = 5e-8, .full = 1e-7}, 1e-3), 20000, 1);
}

/// A millisecond of work at the rates given, in work a second; the GPU brings a batch every 5 ms.
struct TrialRun {
  GpuTrial trial;
  int step = 0;
  bool cold = true;  ///< at first everything takes twice as long

  void run(int milliseconds, double alone, double crew, double gpu) {
    for (int i = 0; i < milliseconds; ++i, ++step) {
      const double rate = (trial.wants_gpu() ? crew : alone) / (cold && step < 10 ? 2 : 1);
      trial.by_crew(rate * 1e-3, 1e-3);
      if (trial.wants_gpu() && step % 5 == 0) trial.by_gpu(gpu * 5e-3, 0, gpu);
    }
  }
};

TEST(GpuTrial, FindsThatAGpuPays) {
  TrialRun run;
  run.run(200, 1e7, 8e6, 2e7);
  EXPECT_TRUE(run.trial.decided());
  EXPECT_TRUE(run.trial.pays());
  EXPECT_NEAR(run.trial.rate_alone(), 1e7, 1e5);
  EXPECT_NEAR(run.trial.rate_both(), 2.8e7, 2e6);
  EXPECT_NEAR(run.trial.walk_share(), 0.1, 0.02);
}

TEST(GpuTrial, IsNotFooledByAColdStart) {
  TrialRun run;
  run.run(200, 1e7, 9e6, 1e5);
  EXPECT_TRUE(run.trial.decided());
  EXPECT_FALSE(run.trial.pays());
  EXPECT_TRUE(run.trial.resting());
}

TEST(GpuTrial, TriesAgainSeldomAndEndsWhatNoLongerPays) {
  TrialRun run;
  run.run(200, 1e7, 5e6, 1e6);
  int wanted = 0;
  for (int i = 0; i < 20'000; ++i) run.run(1, 1e7, 5e6, 1e6), wanted += run.trial.wants_gpu();
  EXPECT_GT(wanted, 0);
  EXPECT_LT(wanted, 400);
  for (int i = 0; i < 100'000 && !run.trial.pays(); ++i) run.run(1, 1e7, 8e6, 2e7);
  EXPECT_TRUE(run.trial.pays());
  for (int i = 0; i < 100'000 && run.trial.pays(); ++i) run.run(1, 1e7, 5e6, 1e6);
  EXPECT_FALSE(run.trial.pays());
}

TEST(GpuTrial, OneTrialWonByLuckIsNotEnough) {
  TrialRun run;
  run.cold = false;
  int switches = 0;
  for (int i = 0; i < 400 && !run.trial.decided(); ++i) {
    const bool wanted = run.trial.wants_gpu();
    run.run(1, switches < 2 ? 5e6 : 1e7, 1e7, 2e6);  // the processor is disturbed until it is measured again
    switches += wanted != run.trial.wants_gpu();
  }
  EXPECT_TRUE(run.trial.decided());
  EXPECT_GE(switches, 2);
}

TEST(GpuTrial, WaitsNoLongerThanASecondForAGpuThatIsSilent) {
  TrialRun run;
  for (int i = 0; i < 1100; ++i) run.trial.by_crew(10'000, 1e-3);
  EXPECT_TRUE(run.trial.resting());
}

TEST(Policy, DrainsAsFastAsAllTogether) {
  const Crew crew = crew_of(2e-7, 2);
  const std::vector<Lane> lanes{lane_of(0, 5e-8)};  // 10 and 20 Mrays/s
  EXPECT_NEAR(drain({0, 3'000'000, crew, lanes}), 0.1, 1e-3);
}

TEST(Policy, ALaneGetsItsShareInBatchesThatShrink) {
  const Crew crew = crew_of(2e-7, 2);
  std::vector<Lane> lanes{lane_of(0, 1e-7)};
  std::size_t before = lanes[0].largest, remaining = 2'000'000;
  while (const std::size_t rays = lane_batch({0, remaining, crew, lanes}, 0)) {
    EXPECT_LE(rays, before);
    before = rays;
    remaining = remaining > 2 * rays ? remaining - 2 * rays : 0;  // the processor is as fast
  }
  EXPECT_LE(before, 2 * lanes[0].smallest);
  EXPECT_LT(remaining, 4 * lanes[0].smallest);
}

TEST(Policy, NothingGoesToALaneThatCannotBeDoneFirst) {
  const Crew crew = crew_of(2e-7, 2);
  const std::vector<Lane> lanes{lane_of(10e-3, 1e-9)};
  EXPECT_EQ(lane_batch({0, 50'000, crew, lanes}, 0), 0u);  // 5 ms of the processor
  EXPECT_GT(lane_batch({0, 1'000'000, crew, lanes}, 0), 0u);
}

TEST(Policy, OverflowsWhenSendingCostsAsMuchAsTracingOrSlotsAreFull) {
  const Crew crew = crew_of(2e-7, 2);
  std::vector<Lane> lanes{lane_of(0, 1e-9, 2.01e-7)};
  EXPECT_EQ(lane_batch({0, 10'000'000, crew, lanes}, 0), 0u);
  lanes[0].walk = 1e-7;
  EXPECT_GT(lane_batch({0, 10'000'000, crew, lanes}, 0), 0u);
  lanes[0].flights.assign(lanes[0].depth, {1000, 1000, 0});
  EXPECT_EQ(lane_batch({0, 10'000'000, crew, lanes}, 0), 0u);
  EXPECT_GT(crew_batch({0, 10'000'000, crew, lanes}), 0u);
}

TEST(Policy, ALostLaneGetsNothing) {
  const Crew crew = crew_of(2e-7, 2);
  std::vector<Lane> lanes{lane_of(0, 1e-9)};
  lanes[0].lost = true;
  EXPECT_EQ(lane_batch({0, 10'000'000, crew, lanes}, 0), 0u);
}

TEST(Policy, AnUnknownLaneIsAskedSeveralThingsAtOnceButNotEverything) {
  const Crew crew;
  std::vector<Lane> lanes(1);
  std::size_t remaining = 1'000'000, sent = 0;
  while (const std::size_t rays = lane_batch({0, remaining, crew, lanes}, 0)) {
    lanes[0].flights.push_back({rays, rays, 0});
    remaining -= rays, sent += rays;
  }
  EXPECT_EQ(lanes[0].flights.size(), lanes[0].depth);
  EXPECT_GT(sent, 300'000u);
  EXPECT_LT(sent, 500'000u);
}

TEST(Policy, AnUnknownLaneCostsLittleSending) {
  const Crew crew = crew_of(2e-7, 2);
  std::vector<Lane> lanes(1);
  lanes[0].walk = 1e-7;
  std::size_t remaining = 1'000'000, sent = 0;
  while (const std::size_t rays = lane_batch({0, remaining, crew, lanes}, 0)) {
    lanes[0].flights.push_back({rays, rays, 0});
    remaining -= rays, sent += rays;
  }
  EXPECT_LE(static_cast<double>(sent) * 1e-7, 0.06 * 1e6 * 2e-7);
}

/// What may be latency must not be waited for twice: after one answer the lane's share goes out as a whole.
TEST(Policy, ALaneThatAnsweredOnceGetsItsShareInOneBatch) {
  const Crew crew = crew_of(2e-7, 2);
  Lane lane;
  lane.model.add(150'000, 11.5e-3);
  lane.flights = {{150'000, 150'000, 0}, {150'000, 150'000, 0}};
  lane.last_landing = 11.5e-3;
  const auto batch = [&] { return lane_batch({11.5e-3, 430'000, crew, {&lane, 1}}, 0); };
  const std::size_t whole = batch();
  EXPECT_GT(whole, 90'000u);
  // Known to be work and no latency: half of the share now, the rest when there is a place again.
  lane.model.add(150'000, 11.5e-3, true);
  EXPECT_LT(batch(), 0.6 * static_cast<double>(whole));
}

TEST(Policy, ThreadsTakeNoMoreThanHalfOfWhatIsLeftForThem) {
  const Crew crew = crew_of(2e-7, 2);
  EXPECT_EQ(crew_batch({0, 10'000'000, crew, {}}), crew.largest);
  EXPECT_LE(crew_batch({0, 4000, crew, {}}), 1010u);
  EXPECT_EQ(crew_batch({0, 100, crew, {}}), 100u);
}

TEST(Policy, ThreadsLeaveTheEndToALaneThatIsDoneSooner) {
  const Crew crew = crew_of(2e-7, 2);
  std::vector<Lane> lanes{lane_of(0, 1e-10)};
  lanes[0].flights.push_back({1000, 1000, 0});
  EXPECT_EQ(crew_batch({0, 10'000, crew, lanes}), 0u);
}

TEST(Policy, WhatIsLateIsTracedAgain) {
  const Crew crew = crew_of(2e-7, 2);
  std::vector<Lane> lanes{lane_of(1e-3, 1e-8)};
  lanes[0].flights.push_back({10'000, 10'000, 0});  // due after 1.1 ms; the processor takes 1 ms
  EXPECT_FALSE(crew_again({0.5e-3, 0, crew, lanes}));
  const auto [finish, late] = forecast(lanes[0], 0);
  EXPECT_NEAR(finish, 1.1e-3, 1e-6);
  const auto again = crew_again({late + 1e-6, 0, crew, lanes});
  ASSERT_TRUE(again);
  EXPECT_EQ(again->rays, crew.largest);
  lanes[0].flights[0].open = 0;  // others have taken all of it
  EXPECT_FALSE(crew_again({1, 0, crew, lanes}));
}

TEST(Policy, WhatASilentLaneHasIsTracedAgainByTheFastestOther) {
  const Crew crew = crew_of(2e-7, 2);
  std::vector<Lane> lanes{Lane{}, lane_of(0, 1e-9), lane_of(0, 1e-8)};
  lanes[0].flights.push_back({50'000, 50'000, 0});
  EXPECT_TRUE(crew_again({1e-3, 0, crew, lanes}));
  EXPECT_FALSE(lane_again({1e-3, 0, crew, lanes}, 0));
  EXPECT_TRUE(lane_again({1e-3, 0, crew, lanes}, 1));
  EXPECT_FALSE(lane_again({1e-3, 0, crew, lanes}, 2));
}

TEST(Policy, AnOverdueLaneIsExpectedLaterAndLater) {
  std::vector<Lane> lanes{lane_of(0, 1e-8)};
  lanes[0].flights.push_back({100'000, 100'000, 0});
  EXPECT_NEAR(ready(lanes[0], 0), 1e-3, 1e-6);
  EXPECT_NEAR(ready(lanes[0], 11e-3), 21e-3, 1e-5);
}

}  // namespace
}  // namespace rayengine
