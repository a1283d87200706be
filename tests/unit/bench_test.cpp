#include "engine/measure/bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "engine/measure/contestant.h"

namespace rayengine {
namespace {

Scene spheres() {
  GeometryBuilder builder;
  for (int i = 0; i < 5; ++i) builder.add(QuadricShape{}, 0, Affine::translate({2.5 * i - 5, 0, 0}));
  Scene scene;
  scene.geometry = builder.build();
  scene.camera = framing_camera(scene.geometry->bounds);
  scene.lights = {{.position = {20, -2, 0}}};  // along the row, so that spheres shade each other
  return scene;
}

BenchOptions small(std::vector<std::string> tracers, std::vector<Precision> precisions) {
  return {.tracers = std::move(tracers), .precisions = std::move(precisions), .size = {40, 30}};
}

TEST(Bench, TimesAndChecksEveryCombinationThatThereIs) {
  std::vector<std::string> left_out;
  double last = 0;
  BenchOptions options = small({"embree", "embree-sphere", "embree-bare"}, {Precision::fast, Precision::robust});
  options.progress = [&](double share) { last = share; };
  const std::vector<BenchRow> rows = bench(spheres(), options, left_out);
  std::set<std::tuple<std::string, Precision, std::string>> seen;
  for (const BenchRow& row : rows) {
    seen.insert({row.tracer, row.precision, row.ray_class});
    EXPECT_GT(row.mrays_per_s, 0);
    EXPECT_GE(row.mrays_per_s_iqr, 0);
    EXPECT_GT(row.build_seconds, 0);
    EXPECT_GT(row.bytes, 0u);
    EXPECT_GT(row.errors.rays, 0u);
    EXPECT_GT(row.errors.hits, 0u) << row.ray_class;
  }
  EXPECT_EQ(seen.size(), rows.size());
  EXPECT_EQ(rows.size(), 2u * 2u * 4u);
  EXPECT_EQ(left_out.size(), 2u) << "no triangles for embree-bare, at either precision";
  EXPECT_EQ(last, 1);
}

TEST(Bench, NothingToMeasureIsAnError) {
  std::vector<std::string> left_out;
  EXPECT_THROW(bench(spheres(), small({"embree-bare"}, {Precision::robust}), left_out), Error);
}

/// Answers all rays but the last of a query.
class Forgetful : public Tracer {
 public:
  std::string_view name() const override { return "forgetful"; }
  Precision precision() const override { return Precision::robust; }
  Limits limits() const override { return {}; }
  double build_seconds() const override { return 0; }
  std::size_t bytes() const override { return 0; }
  void closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass) override {
    std::fill_n(hits.begin(), rays.size() - 1, Hit{});
  }
  void any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass) override {
    std::fill_n(status.begin(), rays.size() - 1, status_miss);
  }
  HitLists all(std::span<const Ray>) override { return {}; }
};

TEST(Contestant, AnswersThatWereNeverWrittenAreNoticed) {
  const auto contestant = make_contestant(std::make_unique<Forgetful>());
  const std::vector<Ray> rays(10);
  contestant->poison(rays.size());
  contestant->closest(rays, RayClass::bounce);
  contestant->any(rays, RayClass::bounce);
  EXPECT_FALSE(contestant->hit(8).hit());
  EXPECT_EQ(contestant->status(8), status_miss);
  EXPECT_THROW(contestant->hit(9), Error);
  EXPECT_THROW(contestant->status(9), Error);
}

}  // namespace
}  // namespace rayengine
