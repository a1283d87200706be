// The cones tracer's own parts: its cones are built on the device, whose arithmetic must hold them together too.

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "cpu/reference_tracer.h"
#include "engine/measure/compare.h"
#include "engine/measure/rays.h"
#include "gpu/cones/cones_pass.h"
#include "gpu/cones/cones_tracer.h"
#include "gpu/stream/stream_batch.h"
#include "tests/ray_tiles.h"

namespace rayengine {
namespace {

constexpr GLsizei tile = 16, side = 64;
constexpr std::size_t rays_a_tile = tile * tile, tiles = side * side / rays_a_tile;

std::shared_ptr<const Geometry> unit_box() {
  GeometryBuilder builder;
  builder.add(Mesh{{{-1, -1, -1}, {1, -1, -1}, {1, 1, 1}}, {}, {{0, 1, 2}}});
  return builder.build();
}

std::vector<glm::vec4> texels(const Texture& texture) {
  std::vector<glm::vec4> result(static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height));
  glGetTextureImage(texture.object.id(), 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(result.size() * sizeof(glm::vec4)),
                    result.data());
  return result;
}

class DeviceCones {
 public:
  DeviceCones() : scene_(unit_box(), context_.info()), pass_(scene_, {side, side}, tile), batch_(side, tile) {}

  /// Rays that end before they begin hold no place in a cone.
  std::vector<RayCone> build(std::span<const test::Tile> all) {
    for (std::size_t i = 0; i < batch_.capacity(); ++i) {
      const test::Tile& from = all[i / rays_a_tile];
      const bool there = i % rays_a_tile < from.size();
      const ConeRay ray = there ? from[i % rays_a_tile] : ConeRay();
      batch_.origins()[batch_.place(i)] = {ray.origin, 0};
      batch_.directions()[batch_.place(i)] = {ray.direction, there ? 1e37f : -1.f};
    }
    batch_.upload(batch_.capacity());
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    pass_.build({side, side});
    const auto apexes = texels(pass_.apexes()), axes = texels(pass_.axes());
    std::vector<RayCone> cones;
    for (std::size_t i = 0; i < apexes.size(); ++i)
      cones.push_back({glm::vec3(apexes[i]), glm::vec3(axes[i]), apexes[i].w, axes[i].w});
    context_.check_errors("the test");
    return cones;
  }

 private:
  Context context_;
  ConesScene scene_;
  ConesPass pass_;
  StreamBatch batch_;
};

/// Whether a ray clearly meets the cube that cones are built for.
bool meets_cube(const ConeRay& ray) {
  double enter = 0, leave = infinity;
  for (int i = 0; i < 3; ++i) {
    const double a = (-1. - ray.origin[i]) / ray.direction[i], b = (1. - ray.origin[i]) / ray.direction[i];
    enter = std::max(enter, std::min(a, b)), leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave;
}

class DeviceCone : public testing::TestWithParam<test::TileKind> {};
INSTANTIATE_TEST_SUITE_P(Tiles, DeviceCone, testing::ValuesIn(test::tile_kinds),
                         [](const auto& info) { return info.param.name; });

TEST_P(DeviceCone, HoldsItsRays) {
  DeviceCones device;
  for (std::uint64_t turn = 0; turn < 4; ++turn) {
    std::vector<test::Tile> all;
    for (std::size_t i = 0; i < tiles; ++i) {
      Random random(turn * tiles + i, 7);
      all.push_back(GetParam().make(random));
    }
    const std::vector<RayCone> cones = device.build(all);
    for (std::size_t i = 0; i < tiles; ++i)
      for (const ConeRay& ray : all[i])
        if (meets_cube(ray)) {
          ASSERT_LE(cones[i].cosine, 1);
          ASSERT_TRUE(test::holds(cones[i], ray)) << "turn " << turn << ", tile " << i;
        }
  }
}

TEST(DeviceCone, IsTheProcessorsToRounding) {
  std::vector<test::Tile> all;
  for (std::size_t i = 0; i < tiles; ++i) {
    Random random(i, 8);
    all.push_back(test::bundle(random, rays_a_tile, .1, .1));
    for (ConeRay& ray : all.back()) ray.origin -= ray.origin / 2.f;  // within the cube
  }
  const std::vector<RayCone> cones = DeviceCones().build(all);
  for (std::size_t i = 0; i < tiles; ++i) {
    const RayCone expected = enclosing_cone(all[i]);
    EXPECT_NEAR(cones[i].sine, expected.sine, 1e-3);
    EXPECT_LT(glm::distance(cones[i].axis, expected.axis), 1e-3f);
    EXPECT_LT(glm::distance(cones[i].apex, expected.apex), 1e-2f * glm::length(expected.apex));
  }
}

TEST(DeviceCone, OfRaysThatHaveEndedHoldsNone) {
  for (const RayCone& cone : DeviceCones().build(std::vector<test::Tile>(tiles))) EXPECT_GT(cone.cosine, 1);
}

std::shared_ptr<const Geometry> balls_and_floor() {
  GeometryBuilder builder;
  for (int i = 0; i < 40; ++i)
    builder.add(QuadricShape{i % 2 ? QuadricType::sphere : QuadricType::cylinder}, 0,
                Affine::translate({3 * std::cos(i), 3 * std::sin(2. * i), .2 * i}) * Affine::scale(glm::dvec3(.5)));
  builder.add(QuadricShape{QuadricType::plane}, 0, Affine::translate({0, 0, -2}));
  return builder.build();
}

/// Tiles of any size, those that do not divide the batch and those of one ray included.
TEST(Cones, AnswerTheSameWhateverTheTile) {
  const auto geometry = balls_and_floor();
  const auto oracle = make_reference_tracer(geometry);
  const auto rays = random_rays({{-4, -4, -2}, {4, 4, 8}}, 700);
  for (const int size : {1, 7, 16, 64}) {
    const auto cones = make_cones_tracer(geometry, Precision::robust, {.tile = size});
    EXPECT_EQ(compare(*cones, *oracle, *geometry, rays, RayClass::bounce).beyond_bounds, 0u) << size;
  }
}

/// Intervals that begin behind the origin, where t is below zero and depths cannot follow.
TEST(Cones, SeeBehindTheOriginWhereTheIntervalBeginsThere) {
  const auto geometry = balls_and_floor();
  const auto oracle = make_reference_tracer(geometry);
  auto rays = random_rays({{-4, -4, -2}, {4, 4, 8}}, 700);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i].tmin = i % 2 ? -infinity : -5;
    rays[i].origin += (i % 3) * 40. * rays[i].direction;
  }
  const auto cones = make_cones_tracer(geometry, Precision::robust);
  const Comparison result = compare(*cones, *oracle, *geometry, rays, RayClass::bounce);
  EXPECT_GT(result.hits, 300u);
  EXPECT_EQ(result.beyond_bounds, 0u);
}

/// Of primitives at exactly the same t the lowest ids count, across types and in any order of objects.
TEST(Cones, PreferTheLowestIdsAtTheSameDistance) {
  const Mesh square{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {}, {{0, 1, 2}, {0, 2, 3}}};
  for (const bool mesh_first : {true, false}) {
    GeometryBuilder builder;
    if (mesh_first) builder.add(square);
    builder.add(QuadricShape{QuadricType::disk});
    builder.add(QuadricShape{QuadricType::disk});
    if (!mesh_first) builder.add(square);
    const auto cones = make_cones_tracer(builder.build(), Precision::robust);
    std::vector<Ray> rays;
    for (int i = 0; i < 50; ++i) rays.push_back({{.013 * i - .3, .1, 2}, 0, {0, 0, -1}, infinity});
    std::vector<Hit> hits(rays.size());
    cones->closest(rays, hits, RayClass::primary);
    for (const Hit& hit : hits) ASSERT_EQ(hit.object, 0u);
  }
}

/// No batch may take so long that a driver would end it.
TEST(Cones, TakeFewerRaysAtOnceThroughLargeScenes) {
  Mesh mesh;
  for (unsigned i = 0; i < 40000; ++i) {
    const double x = i % 200, y = i / 200;
    for (const glm::dvec3& corner : {glm::dvec3{x, y, 0}, glm::dvec3{x + 1, y, 0}, glm::dvec3{x, y + 1, 0}})
      mesh.positions.push_back(corner);
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  GeometryBuilder builder;
  builder.add(mesh);
  const auto geometry = builder.build();
  const auto cones = make_cones_tracer(geometry, Precision::robust);
  EXPECT_EQ(make_cones_tracer(unit_box(), Precision::robust)->limits().batch, 65536u);
  EXPECT_LT(cones->limits().batch, 65536u);
  std::vector<Ray> rays;
  for (unsigned i = 0; i < 40000; i += 97) rays.push_back({{i % 200 + .25, i / 200 + .25, 9}, 0, {0, 0, -1}, infinity});
  std::vector<Hit> hits(rays.size());
  cones->closest(rays, hits, RayClass::primary);
  for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(hits[i].primitive, 97 * i);
}

TEST(Cones, RefuseTilesThatCannotBe) {
  for (const int size : {0, -16, 257, 100000})
    EXPECT_THROW(make_cones_tracer(unit_box(), Precision::robust, {.tile = size}), Error) << size;
}

}  // namespace
}  // namespace rayengine
