#include <gtest/gtest.h>

#include <mutex>

#include "accel/stopwatch.h"
#include "engine/hybrid/hybrid_tracer.h"
#include "engine/measure/rays.h"
#include "engine/query.h"
#include "fake_gpu.h"
#include "render_scenes.h"

namespace rayengine::test {
namespace {

// So slow that Embree's own time hardly counts, sanitizers or not.
constexpr double cpu_per_ray = 4e-6;  // of a thread
constexpr double gpu_per_ray = 4e-7;
constexpr int threads = 2;

std::shared_ptr<const Geometry> balls() {
  GeometryBuilder builder;
  for (int i = 0; i < 27; ++i)
    builder.add(unit_sphere, 0, Affine::translate({3. * (i % 3), 3. * (i / 3 % 3), 3. * (i / 9)}));
  return builder.build();
}

/// A hybrid over a paced processor and a paced GPU, what it said, and the GPU.
struct Rig {
  explicit Rig(Fault fault = {}, double latency = 0, double patience = 0, Fault cpu_fault = {}) {
    const HybridOptions options{.threads = threads, .patience = patience, .say = [this](const std::string& text) {
                                  const std::lock_guard lock(mutex);
                                  said.push_back(text);
                                }};
    const auto make_gpu = [=, this] {
      auto made = std::make_unique<PacedTracer>(geometry, latency, gpu_per_ray, false, fault);
      gpu = made.get();
      return made;
    };
    hybrid =
        make_hybrid_tracer(std::make_unique<PacedTracer>(geometry, 0, cpu_per_ray, true, cpu_fault), make_gpu, options);
  }

  /// A failure is told after others have gone on with the rays: up to some seconds later on a busy machine.
  std::vector<std::string> all_said() {
    for (int wait = 0;; ++wait) {
      {
        const std::lock_guard lock(mutex);
        if (!said.empty() || wait == 5000) return said;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  std::mutex mutex;
  std::vector<std::string> said;
  std::shared_ptr<const Geometry> geometry = balls();
  std::atomic<PacedTracer*> gpu = nullptr;
  std::unique_ptr<Hybrid> hybrid;  // last: it says things until it is gone
};

bool same(const Hit& a, const Hit& b) {
  return a.t == b.t && a.object == b.object && a.primitive == b.primitive && a.status == b.status;
}

/// Asks the hybrid, and expects Embree's answers; returns the seconds it took.
double expect_right(Rig& rig, std::size_t count) {
  const std::vector<Ray> rays = random_rays(rig.geometry->bounds, count, 5);
  std::vector<Hit> hits(count), right(count);
  for (Hit& hit : hits) hit.status = 77;  // nobody's answer
  const Stopwatch watch;
  rig.hybrid->closest(rays, hits, RayClass::primary);
  const double seconds = watch.seconds();
  closest(*make_embree_tracer(rig.geometry, Precision::robust), rays, right, RayClass::primary);
  for (std::size_t i = 0; i < count; ++i)
    if (!same(hits[i], right[i])) {
      ADD_FAILURE() << "ray " << i;
      break;
    }
  return seconds;
}

/// A GPU that was slow in its trial, on a busy machine, gets its next batch only in the next trial.
bool still_to_fail(const Rig& rig, const Fault& fault, int queries) {
  constexpr int most = 400;
  return rig.gpu.load()->batches() <= fault.batch && queries < most;
}

/// A few queries, and as many more as it takes until the GPU had the batch that fails.
void expect_right_until_it_fails(Rig& rig, const Fault& fault) {
  for (int query = 0; query < 3 || still_to_fail(rig, fault, query); ++query) expect_right(rig, 75'000);
}

TEST(Hybrid, SharesRaysAndAnswersThemLikeOneTracer) {
  Rig rig;
  expect_right(rig, 100'000);
  const HybridReport report = rig.hybrid->report();
  EXPECT_GT(report.gpu_rays, 20'000u);
  EXPECT_GT(report.cpu_rays, 5'000u);
  EXPECT_EQ(report.gpu_rays + report.cpu_rays, 100'000u);
  EXPECT_FALSE(rig.gpu.load()->overlapped());
  EXPECT_TRUE(rig.said.empty());
}

TEST(Hybrid, SaysWhyAndHowMuch) {
  Rig rig;
  for (int i = 0; i < 6; ++i) expect_right(rig, 75'000);
  const HybridReport report = rig.hybrid->report();
  ASSERT_EQ(report.classes.size(), 1u);
  const HybridClassReport& primary = report.classes[0];
  EXPECT_EQ(primary.kind, "primary");
  EXPECT_TRUE(report.decided);
  EXPECT_TRUE(report.gpu_pays);
  EXPECT_GT(report.gain, 1.02);
  EXPECT_GT(primary.rate_alone, 0.3 * threads / cpu_per_ray);
  EXPECT_LT(primary.rate_alone, 1.05 * threads / cpu_per_ray);
  EXPECT_GT(primary.gpu_per_ray, 0.2 * gpu_per_ray);
  EXPECT_LT(primary.gpu_per_ray, cpu_per_ray);
  EXPECT_GT(primary.achieved, primary.rate_alone);
  EXPECT_GT(primary.bound, primary.rate_alone);
  EXPECT_NE(report.why.find("the GPU pays"), std::string::npos) << report.why;
}

TEST(Hybrid, AnswersAnyHitAndAllHitsToo) {
  Rig rig;
  const std::vector<Ray> rays = random_rays(rig.geometry->bounds, 50'000, 3);
  std::vector<std::uint32_t> status(rays.size(), 77), right(rays.size());
  rig.hybrid->any(rays, status, RayClass::shadow);
  const auto embree = make_embree_tracer(rig.geometry, Precision::robust);
  any(*embree, rays, right, RayClass::shadow);
  EXPECT_EQ(status, right);
  const std::span<const Ray> few = std::span(rays).first(5000);
  EXPECT_EQ(rig.hybrid->all(few).offsets, all(*embree, few).offsets);
}

TEST(Hybrid, TakesQueriesFromManyThreads) {
  Rig rig;
  std::vector<std::jthread> callers;
  std::atomic<int> wrong = 0;
  for (int c = 0; c < 4; ++c)
    callers.emplace_back([&, c] {
      const auto embree = make_embree_tracer(rig.geometry, Precision::robust);
      for (std::size_t count : {1ul, 300ul, 4096ul, 30'000ul, 5000ul}) {
        const std::vector<Ray> rays = random_rays(rig.geometry->bounds, count, static_cast<std::uint64_t>(c));
        std::vector<Hit> hits(count), right(count);
        rig.hybrid->closest(rays, hits, RayClass::bounce);
        embree->closest(rays, right, RayClass::bounce);
        for (std::size_t i = 0; i < count; ++i) wrong += !same(hits[i], right[i]);
      }
    });
  callers.clear();
  EXPECT_EQ(wrong, 0);
}

TEST(Hybrid, NoRaysNeedNoAnswers) {
  Rig rig;
  rig.hybrid->closest({}, {}, RayClass::primary);
}

TEST(Hybrid, LeavesAGpuThatDoesNotPayAlone) {
  GeometryBuilder builder;
  builder.add(unit_sphere);
  const auto geometry = builder.build();
  const auto hybrid = make_hybrid_tracer(std::make_unique<PacedTracer>(geometry, 0, cpu_per_ray, true),
                                         [&] { return std::make_unique<PacedTracer>(geometry, 0, 2.5e-4, false); },
                                         {.threads = threads});
  const std::vector<Ray> rays = random_rays(geometry->bounds, 50'000);
  std::vector<Hit> hits(rays.size());
  for (int i = 0; i < 20; ++i) hybrid->closest(rays, hits, RayClass::primary);
  EXPECT_LT(hybrid->report().gpu_rays, 50'000u);
  EXPECT_NE(hybrid->report().why.find("more than it brings"), std::string::npos) << hybrid->report().why;
}

TEST(Hybrid, GoesOnWithoutAGpuAndSaysSoOnce) {
  std::vector<std::string> said;
  const auto geometry = balls();
  const auto hybrid = make_hybrid_tracer(make_embree_tracer(geometry, Precision::robust),
                                         []() -> std::unique_ptr<Tracer> { throw Error("none here"); },
                                         {.say = [&](const std::string& text) { said.push_back(text); }});
  const std::vector<Ray> rays = random_rays(geometry->bounds, 10'000);
  std::vector<Hit> hits(rays.size());
  hybrid->closest(rays, hits, RayClass::primary);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("none here"), std::string::npos);
  EXPECT_EQ(hybrid->limits().quadric_roundoff,
            make_embree_tracer(geometry, Precision::robust)->limits().quadric_roundoff);
}

TEST(Hybrid, LooksForAGpuOnlyWhenThereIsWork) {
  Rig rig({}, 0, 0.05);
  expect_right(rig, 1000);
  EXPECT_EQ(rig.gpu.load(), nullptr);
  for (int i = 0; i < 10; ++i) expect_right(rig, 25'000);
  EXPECT_NE(rig.gpu.load(), nullptr);
  EXPECT_GT(rig.hybrid->report().gpu_rays, 0u);
}

// Faults. Whatever happens: all answers right, one line said, and no waiting for a device that is away.

TEST(HybridFault, AStallOfSecondsIsNotWaitedFor) {
  Rig rig({Fault::Kind::stall, 3, 3});
  EXPECT_LT(expect_right(rig, 375'000), 2.5);  // 0.75 s of the processor alone
  EXPECT_LE(rig.said.size(), 1u);
}

TEST(HybridFault, ASlowDownByAHundredCostsLittle) {
  Rig rig({Fault::Kind::slow, 3});
  EXPECT_LT(expect_right(rig, 100'000), 1.0);
  EXPECT_LT(expect_right(rig, 100'000), 1.0);
}

TEST(HybridFault, AnErrorInABatchGivesItsRaysBack) {
  for (const int batch : {0, 1, 4}) {
    const Fault fault{Fault::Kind::error, batch};
    Rig rig(fault);
    expect_right_until_it_fails(rig, fault);
    const std::vector<std::string> said = rig.all_said();
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("a made error"), std::string::npos);
    EXPECT_NE(rig.hybrid->report().why.find("failed"), std::string::npos);
  }
}

TEST(HybridFault, ALostContextLosesNothing) {
  const Fault fault{Fault::Kind::lost, 2};
  Rig rig(fault);
  expect_right_until_it_fails(rig, fault);
  const std::vector<std::string> said = rig.all_said();
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("context is lost"), std::string::npos);
}

TEST(HybridFault, AGpuThatIsKilledMeanwhileLosesNothing) {
  Rig rig({}, 5e-3);
  std::atomic<bool> done = false;
  std::jthread killer([&] {
    while (!done && rig.gpu.load()->batches() < 2) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    rig.hybrid->lose_gpu();
  });
  expect_right_until_it_fails(rig, {.batch = 1});
  done = true;
  killer.join();
  expect_right(rig, 75'000);
  EXPECT_EQ(rig.all_said().size(), 1u);
}

/// Queries so small that their callers answer them without TBB, whose threads the thread sanitizer does not understand.
TEST(HybridFault, ManyCallersGetTheirAnswers) {
  constexpr std::size_t count = 3000;
  for (const Fault& fault : {Fault{}, Fault{Fault::Kind::slow, 2}, Fault{Fault::Kind::error, 2},
                             Fault{Fault::Kind::lost, 4}, Fault{Fault::Kind::stall, 4, 0.3}}) {
    Rig rig(fault);
    const std::vector<Ray> rays = random_rays(rig.geometry->bounds, count);
    std::vector<Hit> right(count);
    make_embree_tracer(rig.geometry, Precision::robust)->closest(rays, right, RayClass::bounce);
    std::atomic<int> wrong = 0;
    std::vector<std::jthread> callers;
    for (int c = 0; c < 4; ++c)
      callers.emplace_back([&] {
        for (int query = 0; query < 40 || still_to_fail(rig, fault, query); ++query) {
          std::vector<Hit> hits(count);
          rig.hybrid->closest(rays, hits, RayClass::bounce);
          for (std::size_t i = 0; i < count; ++i) wrong += !same(hits[i], right[i]);
        }
      });
    callers.clear();
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(rig.gpu.load()->batches(), fault.batch);
  }
}

/// Once the processor's tracer throws: one query fails, whoever of the callers had its rays, and no other.
TEST(HybridFault, AnErrorOfTheProcessorIsThatOfOneQuery) {
  constexpr std::size_t count = 3000;
  Rig rig({}, 0, 0, {Fault::Kind::error, 9});
  const std::vector<Ray> rays = random_rays(rig.geometry->bounds, count);
  std::vector<Hit> right(count);
  make_embree_tracer(rig.geometry, Precision::robust)->closest(rays, right, RayClass::bounce);
  std::atomic<int> wrong = 0, failed = 0;
  std::vector<std::jthread> callers;
  for (int c = 0; c < 4; ++c)
    callers.emplace_back([&] {
      for (int query = 0; query < 20; ++query) {
        std::vector<Hit> hits(count);
        try {
          rig.hybrid->closest(rays, hits, RayClass::bounce);
          for (std::size_t i = 0; i < count; ++i) wrong += !same(hits[i], right[i]);
        } catch (const Error&) {
          ++failed;
        }
      }
    });
  callers.clear();
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(failed, 1);
  EXPECT_TRUE(rig.said.empty());
}

TEST(HybridFault, AnErrorOfTheProcessorLeavesThePoolUsable) {
  Rig rig({}, 0, 0, {Fault::Kind::error, 3});
  std::vector<Hit> hits(75'000);
  EXPECT_THROW(rig.hybrid->closest(random_rays(rig.geometry->bounds, hits.size()), hits, RayClass::primary), Error);
  for (int i = 0; i < 2; ++i) expect_right(rig, 75'000);
}

/// The error cancels the other tiles' loops, whose queries are under way.
TEST(RenderInvarianceHybrid, AnErrorOfTheProcessorEndsAPicture) {
  Scene scene;
  scene.geometry = balls();
  scene.materials = {{.reflect = 0.4f}};
  scene.lights = {point_light({10, -10, 20})};
  scene.camera = {.from = {3, -14, 8}, .at = {3, 3, 3}, .up = {0, 0, 1}, .fov = 45, .size = {240, 180}};
  for (const int batch : {0, 7, 25}) {
    Rig rig({}, 0, 0, {Fault::Kind::lost, batch});
    EXPECT_THROW(render(scene, *rig.hybrid, {.depth = 3, .threads = threads}), Error) << batch;
  }
}

TEST(RenderInvarianceHybrid, FaultsOfTheGpuLeavePicturesAsTheyAre) {
  Scene scene;
  scene.geometry = balls();
  scene.materials = {{.color = {1, 0.8f, 0.6f}, .reflect = 0.4f}};
  scene.lights = {point_light({10, -10, 20})};
  scene.camera = {.from = {3, -14, 8}, .at = {3, 3, 3}, .up = {0, 0, 1}, .fov = 45, .size = {240, 180}};
  const auto picture = [&](Fault fault) {
    Rig rig(fault);
    std::vector<float> pixels;
    const RenderResult result = render(scene, *rig.hybrid, {.depth = 3, .threads = threads});
    for (int y = 0; y < 180; ++y)
      pixels.insert(pixels.end(), result.image.pixel(0, y), result.image.pixel(0, y) + 4 * 240);
    EXPECT_GT(rig.gpu.load()->batches(), fault.batch) << static_cast<int>(fault.kind);
    return pixels;
  };
  const std::vector<float> right = picture({});
  // Of the first batches of the trial: whether others follow is the machine's to say.
  for (const Fault& fault : {Fault{Fault::Kind::stall, 1, 1.0}, Fault{Fault::Kind::slow, 1},
                             Fault{Fault::Kind::error, 1}, Fault{Fault::Kind::lost, 0}})
    EXPECT_EQ(picture(fault), right) << static_cast<int>(fault.kind);
}

}  // namespace
}  // namespace rayengine::test
