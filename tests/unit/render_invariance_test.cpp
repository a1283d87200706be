#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>

#include "render_scenes.h"

namespace rayengine::test {
namespace {

/// Glass, mirrors and a mesh under two lights: every kind of ray, several levels deep.
Scene busy_scene() {
  GeometryBuilder builder;
  builder.add(ground, 0, Affine::translate({0, 0, -1}));
  builder.add(unit_sphere, 1);
  builder.add(globe(12), 2, Affine::translate({2, 1, 0}));
  builder.add(unit_sphere, 2, Affine::translate({-2, 1, 0}));
  Scene scene;
  scene.camera = {.from = {0, -6, 1.5}, .at = {0, 0, 0}, .size = {75, 41}};
  scene.background.color = {0.2f, 0.3f, 0.5f};
  scene.materials = {
      {.color = {0.5f, 0.6f, 0.4f}, .ambient = 0.1f, .reflect = 0.2f},
      {.color = {0.9f, 1, 1}, .diffuse = 0.1f, .specular = 0.5f, .reflect = 0.3f, .transmit = 0.7f, .ior = 1.5f},
      {.color = {0.8f, 0.3f, 0.2f}, .specular = 0.4f, .reflect = 0.4f}};
  scene.lights = {point_light({4, -4, 6}, {0.7f, 0.6f, 0.5f}),
                  {.type = Light::Type::directional, .direction = {1, 1, -1}, .color = {0.3f, 0.4f, 0.5f}}};
  scene.geometry = builder.build();
  return scene;
}

/// A real tracer that asks for waves of another size, one caller at a time, and notes whether it gets that.
class Narrow : public Tracer {
 public:
  Narrow(std::unique_ptr<Tracer> inner, std::size_t batch) : inner_(std::move(inner)), batch_(batch) {}

  std::string_view name() const override { return inner_->name(); }
  Precision precision() const override { return inner_->precision(); }
  Limits limits() const override {
    Limits limits = inner_->limits();
    limits.concurrent = false;
    limits.batch = batch_;
    return limits;
  }
  double build_seconds() const override { return inner_->build_seconds(); }
  std::size_t bytes() const override { return inner_->bytes(); }
  void closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) override {
    const Visit visit(*this);
    largest = std::max(largest, rays.size());
    inner_->closest(rays, hits, ray_class);
  }
  void any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) override {
    const Visit visit(*this);
    inner_->any(rays, status, ray_class);
  }
  HitLists all(std::span<const Ray> rays) override { return inner_->all(rays); }

  bool crowded = false;
  std::size_t largest = 0;

 private:
  struct Visit {
    explicit Visit(Narrow& n) : narrow(n) { narrow.crowded |= narrow.inside_++ != 0; }
    ~Visit() { --narrow.inside_; }
    Narrow& narrow;
  };

  std::unique_ptr<Tracer> inner_;
  std::size_t batch_;
  std::atomic<int> inside_ = 0;
};

TEST(RenderInvariance, AnyNumberOfThreadsGivesTheSameBits) {
  const Scene scene = busy_scene();
  const RenderResult one = render_with("embree", scene, {.spp = 3, .aovs = {Aov::depth, Aov::normal}, .threads = 1});
  for (int threads : {2, 3, 0}) {
    const RenderResult more =
        render_with("embree", scene, {.spp = 3, .aovs = {Aov::depth, Aov::normal}, .threads = threads});
    EXPECT_EQ(more.image.pixels, one.image.pixels) << threads;
    EXPECT_EQ(more.stats.rays, one.stats.rays) << threads;
  }
}

TEST(RenderInvariance, AnySizeOfWavesGivesTheSameBits) {
  const Scene scene = busy_scene();
  const RenderOptions options{.depth = 7, .spp = 5, .threads = 2};
  const RenderResult usual = render_with("embree", scene, options);
  EXPECT_GT(usual.stats.rays[3], 1000u);
  for (std::size_t batch : {std::size_t{1}, std::size_t{100}, std::size_t{1} << 20}) {
    Narrow tracer(make_tracer("embree", scene.geometry), batch);
    const RenderResult result = render(scene, tracer, options);
    EXPECT_EQ(result.image.pixels, usual.image.pixels) << batch;
    EXPECT_EQ(result.stats.rays, usual.stats.rays) << batch;
    EXPECT_FALSE(tracer.crowded);
    EXPECT_EQ(tracer.largest, batch == 1 ? 64u : batch == 100 ? 100u : 75u * 41 * 5) << batch;
  }
}

TEST(RenderInvariance, TheOracleGivesTheSamePicture) {
  Scene scene = busy_scene();
  scene.camera.size = {24, 16};
  const RenderResult embree = render_with("embree", scene), oracle = render_with("reference", scene);
  int differing = 0;
  for (std::size_t i = 0; i < embree.image.pixels.size(); ++i)
    differing += std::abs(embree.image.pixels[i] - oracle.image.pixels[i]) > 1.0f / 255;
  EXPECT_LE(differing, 3);
}

TEST(RenderInvariance, ProgressEndsAtOne) {
  std::atomic<int> calls = 0, ends = 0;
  render_with("embree", busy_scene(), {.progress = [&](double share) {
                ++calls;
                ends += share == 1;
              }});
  EXPECT_GT(calls, 1);
  EXPECT_EQ(ends, 1);
}

/// A white half of the image plane whose edge runs `distance` pixels to the right of the pixel's centre.
float half_plane(double distance, int spp) {
  GeometryBuilder builder;
  const double pixel = 2 * std::tan(std::acos(-1) / 8);  // 45 degrees at unit distance
  builder.add(Mesh{{{distance * pixel, 0, 50}, {distance * pixel, 0, -50}, {-50, 0, 0}}, {}, {{0, 1, 2}}});
  const Scene scene = scene_of(builder, {.color = glm::vec3(1), .ambient = 1}, one_ray({0, -1, 0}, {0, 0, 0}));
  return seen(scene, {.spp = spp}).x;
}

TEST(RenderSamples, MoreSamplesApproachTheFilteredEdge) {
  // Harris' window over three pixels, integrated by hand up to 0.3 pixels right of the centre.
  const double w = std::acos(-1) * 0.3 / 1.5;
  const double covered = 0.5 + 0.3 / 3 +
                         (0.48829 * std::sin(w) + 0.14128 * std::sin(2 * w) / 2 + 0.01168 * std::sin(3 * w) / 3) /
                             (0.35875 * 2 * std::acos(-1));
  EXPECT_NEAR(half_plane(0.3, 16), covered, 1.0 / 16);
  EXPECT_NEAR(half_plane(0.3, 256), covered, 1.0 / 256);
  EXPECT_NEAR(half_plane(0.3, 4096), covered, 1.0 / 1024);
  EXPECT_EQ(half_plane(0.01, 1), 1);
  EXPECT_EQ(half_plane(-0.01, 1), 0);
}

TEST(RenderAovs, AreThoseOfThePixelsCentre) {
  GeometryBuilder builder;
  builder.add(ground, 0, Affine::translate({0, 0, -10}));
  builder.add(globe(4));
  Scene scene = scene_of(builder, {}, one_ray({0, -4, 3}, {0.05, 0.1, 0.1}));
  const std::vector<Aov> aovs{Aov::depth, Aov::normal, Aov::object, Aov::primitive, Aov::position, Aov::error};
  const RenderResult result = render_with("embree", scene, {.spp = 3, .aovs = aovs});
  EXPECT_EQ(result.image.channels, (std::vector<std::string>{"R", "G", "B", "A", "Z", "N.X", "N.Y", "N.Z", "object",
                                                             "primitive", "P.X", "P.Y", "P.Z", "error"}));
  const auto oracle = make_tracer("reference", scene.geometry);
  const Ray ray = camera_ray(scene.camera, 0.5, 0.5);
  Hit hit;
  oracle->closest({&ray, 1}, {&hit, 1}, RayClass::primary);
  const float* p = result.image.pixel(0, 0);
  const glm::dvec3 point = ray.at(hit.t);
  EXPECT_EQ(p[3], 1);
  EXPECT_FLOAT_EQ(p[4], static_cast<float>(hit.t));
  EXPECT_EQ(p[8], 1);
  EXPECT_EQ(p[9], static_cast<float>(hit.primitive));
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(p[5 + i], hit.normal[i], 1e-6);
    EXPECT_NEAR(p[10 + i], point[i], 1e-6);
  }
}

/// Down on the edge that the halves of a square share, and beside it.
TEST(RenderAovs, StatusShowsWhereRaysWereHard) {
  GeometryBuilder builder;
  builder.add(Mesh{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {}, {{0, 1, 2}, {0, 2, 3}}});
  const auto status = [&, geometry = builder.build()](const glm::dvec3& at) {
    Scene scene;
    scene.geometry = geometry;
    scene.camera = one_ray(at + glm::dvec3(0, 0, 2), at);
    scene.camera.up = {0, 1, 0};
    return render_with("reference", scene, {.aovs = {Aov::status}}).image.pixel(0, 0)[4];
  };
  EXPECT_EQ(status({0.5, 0.5, 0}), status_hit | status_tie);
  EXPECT_EQ(status({0.5, 0.25, 0}), status_hit);
  EXPECT_EQ(status({5, 0, 0}), status_miss);
}

TEST(RenderAovs, AMissIsInfinitelyFarAndHasNoIds) {
  GeometryBuilder builder;
  builder.add(unit_sphere);
  const Scene scene = scene_of(builder, {}, one_ray({0, -4, 0}, {0, -4, 1}));
  const RenderResult result = render_with("embree", scene, {.aovs = {Aov::primitive, Aov::depth, Aov::normal}});
  const float* p = result.image.pixel(0, 0);
  EXPECT_EQ(p[4], -1);
  EXPECT_EQ(p[5], std::numeric_limits<float>::infinity());
  EXPECT_EQ(glm::vec3(p[6], p[7], p[8]), glm::vec3(0));
}

}  // namespace
}  // namespace rayengine::test
