// Answers that come twice: the first to claim a block writes it, the other's are dropped.

#include "engine/hybrid/batch.h"

#include <gtest/gtest.h>

#include <thread>

namespace rayengine {
namespace {

constexpr std::size_t rays_a = 1000, rays_b = 777;

struct Query {
  std::vector<Ray> rays;
  std::vector<std::uint32_t> status;
  std::shared_ptr<Job> job;

  explicit Query(std::size_t count)
      : rays(count),
        status(count, 99),
        job(std::make_shared<Job>(WorkKind{.any = true}, rays, AnswerSpans{{}, status})) {}
};

/// A batch of all rays of two queries, which lie across its blocks.
struct TwoQueries {
  Query a{rays_a}, b{rays_b};
  Batch batch{{.any = true}};

  TwoQueries() {
    batch.add(a.job, 0, rays_a);
    batch.add(b.job, 0, rays_b);
    batch.stage();
  }
  std::size_t deliver(std::uint32_t answer) {
    std::vector<std::uint32_t> answers(batch.size(), answer);
    return batch.deliver(0, batch.blocks(), {{}, answers});
  }
};

TEST(Batch, WhatComesSecondIsDropped) {
  TwoQueries queries;
  EXPECT_EQ(queries.deliver(1), rays_a + rays_b);
  EXPECT_TRUE(queries.a.job->done() && queries.b.job->done());
  EXPECT_EQ(queries.deliver(0), 0u);
  EXPECT_EQ(queries.a.status, std::vector<std::uint32_t>(rays_a, 1));
  EXPECT_EQ(queries.b.status, std::vector<std::uint32_t>(rays_b, 1));
}

TEST(Batch, ASecondAnswerFillsOnlyWhatIsOpen) {
  TwoQueries queries;
  std::vector<std::uint32_t> some(Batch::block, 1);
  EXPECT_EQ(queries.batch.deliver(2, 3, {{}, some}), Batch::block);
  EXPECT_EQ(queries.deliver(0), rays_a + rays_b - Batch::block);
  for (std::size_t i = 0; i < rays_a; ++i) EXPECT_EQ(queries.a.status[i], i / Batch::block == 2) << i;
}

TEST(Batch, RacersAnswerEveryRayOnce) {
  TwoQueries queries;
  std::atomic<std::size_t> delivered = 0;
  {
    std::vector<std::jthread> racers;
    for (std::uint32_t k = 0; k < 8; ++k) racers.emplace_back([&, k] { delivered += queries.deliver(k); });
  }
  EXPECT_EQ(delivered, rays_a + rays_b);
  EXPECT_TRUE(queries.a.job->done() && queries.b.job->done());
  for (std::size_t i = 0; i < rays_a; ++i) {
    EXPECT_LT(queries.a.status[i], 8u);
    EXPECT_EQ(queries.a.status[i], queries.a.status[i / Batch::block * Batch::block]) << "a block has one author";
  }
}

}  // namespace
}  // namespace rayengine
