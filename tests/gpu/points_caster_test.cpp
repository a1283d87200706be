// Pictures cast and composited on the device against the renderer's.

#include "gpu/points/points_caster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <tuple>

#include "accel/tracer.h"
#include "engine/render/cast.h"
#include "engine/render/render.h"
#include "engine/tracers.h"

namespace rayengine {
namespace {

using Method = PointsOptions::Method;

/// A corner of mirroring walls about a tetrahedron, which stand in each other's light and show each other.
Scene corner() {
  GeometryBuilder builder, solid;
  builder.add(Mesh{{{-2, -2, -1}, {2, -2, -1}, {2, 2, -1}, {-2, 2, -1}, {-2, 2, 2}, {2, 2, 2}},
                   {},
                   {{0, 1, 2}, {0, 2, 3}, {3, 2, 5}, {3, 5, 4}}});
  solid.add(Mesh{{{0, 0, -1}, {1, 0, 0}, {0, 1, 0}, {-.5, -.5, .5}}, {}, {{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}},
            1);
  const auto group = solid.build();
  builder.add(group);
  builder.add(group, Affine::translate({-1.2, .3, .4}));
  Scene scene;
  scene.geometry = builder.build();
  scene.camera = {.from = {1, -5, 2}, .at = {0, 0, 0}, .up = {0, 0, 1}, .fov = 45, .size = {96, 80}};
  scene.background.color = {.1f, .2f, .3f};
  scene.lights = {{Light::Type::point, {4, -6, 8}, {}, {.9f, .8f, .7f}},
                  {Light::Type::directional, {}, {1, 1, -1}, {.2f, .2f, .3f}}};
  scene.materials = {
      {.color = {.8f, .2f, .1f}, .ambient = .1f, .diffuse = .8f, .specular = .5f, .shininess = 20, .reflect = .3f},
      {.color = {.1f, .3f, .9f}, .ambient = .05f, .diffuse = .9f, .reflect = .5f}};
  return scene;
}

std::vector<glm::vec3> cast(const Scene& scene, const PointsOptions& options) {
  return PointsCaster(scene.geometry, cast_lights(scene), cast_materials(scene), scene.background.color, options)
      .cast(cast_view(scene.camera));
}

/// Every channel to 2^-16, but for one pixel in 500: rays that pass an edge may see either side of it.
void expect_the_renderers(const Scene& scene, const std::vector<glm::vec3>& colors, int depth) {
  const auto tracer = make_tracer("bvh", scene.geometry);
  const Image image = render(scene, *tracer, {.depth = depth}).image;
  std::size_t wrong = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float* p = image.pixel(x, y);
      const glm::vec3 difference =
          glm::abs(colors[static_cast<std::size_t>(y * image.width + x)] - glm::vec3(p[0], p[1], p[2]));
      wrong += !(std::max({difference.x, difference.y, difference.z}) < 0x1p-16f);
    }
  EXPECT_LE(wrong, colors.size() / 500);
}

class PointsCasting : public testing::TestWithParam<std::tuple<Method, bool>> {
 protected:
  PointsOptions options() const { return {.method = std::get<Method>(GetParam()), .fat = std::get<bool>(GetParam())}; }
};
std::string name_of(const testing::TestParamInfo<PointsCasting::ParamType>& info) {
  constexpr std::array names{"points", "points_without_gs", "fragment"};
  return names[static_cast<std::size_t>(std::get<Method>(info.param))] +
         std::string(std::get<bool>(info.param) ? "_fat" : "");
}
INSTANTIATE_TEST_SUITE_P(Methods, PointsCasting,
                         testing::Combine(testing::Values(Method::points, Method::points_without_gs, Method::fragment),
                                          testing::Bool()),
                         name_of);

TEST_P(PointsCasting, ShadowsAndMirrorsAreTheRenderers) {
  const Scene scene = corner();
  PointsOptions o = options();
  for (const int reflections : {0, 1, 3}) {
    o.reflections = reflections;
    expect_the_renderers(scene, cast(scene, o), reflections);
  }
}

TEST_P(PointsCasting, WithoutShadowsNothingStandsInTheLight) {
  Scene scene = corner();
  PointsOptions without = options();
  without.shadows = false;
  EXPECT_NE(cast(scene, without), cast(scene, options()));
  GeometryBuilder floor;  // on which no shadow falls
  floor.add(Mesh{{{-2, -2, -1}, {2, -2, -1}, {2, 2, -1}, {-2, 2, -1}}, {}, {{0, 1, 2}, {0, 2, 3}}});
  scene.geometry = floor.build();
  expect_the_renderers(scene, cast(scene, without), 0);
}

TEST_P(PointsCasting, AmbientLightIsSeenWithoutLights) {
  Scene scene = corner();
  scene.lights.clear();
  PointsOptions o = options();
  o.reflections = 1;
  expect_the_renderers(scene, cast(scene, o), 1);
}

TEST_P(PointsCasting, WithoutAGridAsWell) {
  PointsOptions o = options();
  o.naive = true, o.reflections = 1;
  expect_the_renderers(corner(), cast(corner(), o), 1);
}

TEST(PointsCaster, PicturesOfOtherSizesMayFollow) {
  Scene scene = corner();
  PointsCaster caster(scene.geometry, cast_lights(scene), cast_materials(scene), scene.background.color,
                      {.reflections = 1});
  for (const glm::ivec2 size : {glm::ivec2{40, 30}, glm::ivec2{64, 64}, glm::ivec2{40, 30}}) {
    scene.camera.size = size;
    expect_the_renderers(scene, caster.cast(cast_view(scene.camera)), 1);
  }
}

TEST(PointsCaster, PartsAreTimedWhereThereAreAny) {
  const Scene scene = corner();
  const CastView view = cast_view(scene.camera);
  const auto caster = [&](const PointsOptions& options) {
    return PointsCaster(scene.geometry, cast_lights(scene), cast_materials(scene), scene.background.color, options);
  };
  PointsCaster three_passes = caster({.reflections = 1});
  EXPECT_THROW(three_passes.time(view, PointsCaster::Part::vertex), Error);
  const auto picture = three_passes.cast(view);
  for (const auto part : {PointsCaster::Part::vertex, PointsCaster::Part::geometry})
    EXPECT_GT(three_passes.time(view, part).elapsed, 0);
  EXPECT_EQ(three_passes.cast(view), picture);
  for (const PointsOptions& options : {PointsOptions{.reflections = 2}, PointsOptions{.method = Method::fragment}}) {
    PointsCaster other = caster(options);
    other.cast(view);
    EXPECT_THROW(other.time(view, PointsCaster::Part::vertex), Error);
  }
}

TEST_P(PointsCasting, WhereThereIsNothingTheBackgroundIsSeen) {
  Scene scene = corner();
  scene.geometry = GeometryBuilder().build();
  const auto colors = cast(scene, options());
  EXPECT_EQ(std::ranges::count(colors, scene.background.color), std::ssize(colors));
}

TEST(PointsCaster, AViewWithoutPixelsIsRefused) {
  const Scene scene = corner();
  PointsCaster caster(scene.geometry, cast_lights(scene), cast_materials(scene), scene.background.color);
  CastView view = cast_view(scene.camera);
  view.height = 0;
  EXPECT_THROW(caster.cast(view), Error);
  view.height = 8;
  EXPECT_EQ(caster.cast(view).size(), static_cast<std::size_t>(8 * view.width));
}

std::string complaint(const Scene& scene, const PointsOptions& options) {
  try {
    cast(scene, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing";
}

class PointsRoom : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Formats, PointsRoom, testing::Bool(),
                         [](const auto& info) { return info.param ? "fat" : "packed"; });

TEST_P(PointsRoom, RaysThatVertexBuffersCannotHoldAreNoticed) {
  const std::string text = complaint(corner(), {.fat = GetParam(), .reflections = 1, .room = .5});
  EXPECT_NE(text.find("rays came where the vertex buffer holds 3840"), text.npos) << text;
  EXPECT_EQ(complaint(corner(), {.fat = GetParam(), .reflections = 1}), "nothing");
}

TEST(PointsCaster, WhatItCannotHoldIsRefused) {
  Scene scene = corner();
  scene.camera.size = {16000, 16000};
  EXPECT_NE(complaint(scene, {}).find("need a vertex buffer of 8192000000 bytes"), std::string::npos);
  scene = corner();
  EXPECT_NE(complaint(scene, {.reflections = 1000}).find("need 3003 layers"), std::string::npos);
  scene.lights.resize(8);
  EXPECT_NE(complaint(scene, {}).find("8 lights, and there are render targets for 7"), std::string::npos);
  scene = corner();
  scene.materials.pop_back();
  EXPECT_NE(complaint(scene, {}).find("material 1, and there are 1"), std::string::npos);
}

}  // namespace
}  // namespace rayengine
