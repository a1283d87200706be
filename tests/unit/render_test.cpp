#include "engine/render/render.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "engine/render/environment.h"
#include "render_scenes.h"

namespace rayengine::test {
namespace {

void expect_color(const glm::vec3& color, const glm::dvec3& expected, double tolerance = 2e-6) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(color[i], expected[i], tolerance) << "channel " << i;
}

Scene lit_sphere() {
  GeometryBuilder builder;
  builder.add(unit_sphere);
  const Material material{
      .color = {0.9f, 0.5f, 0.2f}, .ambient = 0.3f, .diffuse = 0.8f, .specular = 0.6f, .shininess = 9};
  Scene scene = scene_of(builder, material, one_ray({3, -4, 2}, {0.2, 0.1, -0.3}));
  scene.lights = {point_light({5, -1, 4}, {1, 0.5f, 2})};
  return scene;
}

/// The lit sphere's hit, worked out with the schoolbook quadratic.
struct ByHand {
  glm::dvec3 point, to_light, to_eye;
  ByHand() {
    const glm::dvec3 o(3, -4, 2), d = glm::normalize(glm::dvec3(0.2, 0.1, -0.3) - o);
    const double b = glm::dot(o, d), c = glm::dot(o, o) - 1;
    point = o + (-b - std::sqrt(b * b - c)) * d;
    to_light = glm::normalize(glm::dvec3(5, -1, 4) - point);
    to_eye = -d;
  }
  double cosine() const { return glm::dot(point, to_light); }
};

TEST(Render, DirectIsLambertTimesTheLight) {
  const ByHand hand;
  ASSERT_GT(hand.cosine(), 0.1);
  expect_color(seen(lit_sphere(), {.shading = Shading::direct}), 0.8 * hand.cosine() * glm::dvec3(0.9, 0.25, 0.4));
}

TEST(Render, FullAddsAmbientAndAHighlightOfTheLightsColour) {
  const ByHand hand;
  const double highlight = std::pow(glm::dot(hand.point, glm::normalize(hand.to_light + hand.to_eye)), 9);
  ASSERT_GT(highlight, 0.05);
  const glm::dvec3 diffuse = 0.8 * hand.cosine() * glm::dvec3(0.9, 0.25, 0.4);
  expect_color(seen(lit_sphere()), 0.3 * glm::dvec3(0.9, 0.5, 0.2) + diffuse + 0.6 * highlight * glm::dvec3(1, 0.5, 2),
               5e-6);
}

TEST(Render, BothSidesOfASurfaceAreLit) {
  Scene scene = lit_sphere();
  scene.camera = one_ray({0, 0, 0}, {1, 0, 0});
  scene.lights = {point_light({0, 0.5, 0})};
  expect_color(seen(scene, {.shading = Shading::direct}), 0.8 / std::sqrt(1.25) * glm::dvec3(0.9, 0.5, 0.2));
}

TEST(Render, ADirectionalLightShinesFromAfar) {
  Scene scene = lit_sphere();
  scene.camera = one_ray({0, -5, 0}, {0, 0, 0});
  scene.lights = {{.type = Light::Type::directional, .direction = {3, 4, 0}, .color = glm::vec3(1)}};
  expect_color(seen(scene, {.shading = Shading::direct}), 0.8 * 0.8 * glm::dvec3(0.9, 0.5, 0.2));
  scene.lights[0].direction = {3, -4, 0};
  expect_color(seen(scene, {.shading = Shading::direct}), glm::dvec3(0));
}

/// The ground at its origin under a light 4 above, with a small ball at height z.
glm::vec3 ground_below_ball(double z) {
  GeometryBuilder builder;
  builder.add(ground);
  builder.add(unit_sphere, 0, Affine::translate({0, 0, z}) * Affine::scale(glm::dvec3(0.25)));
  Scene scene = scene_of(builder, {.color = glm::vec3(1), .diffuse = 0.5f}, one_ray({0, -5, 1}, {0, 0, 0}));
  scene.lights = {point_light({0, 0, 4})};
  return seen(scene, {.shading = Shading::direct});
}

TEST(Render, OnlyWhatStandsBeforeALightCastsItsShadow) {
  expect_color(ground_below_ball(2), glm::dvec3(0));
  expect_color(ground_below_ball(3.7), glm::dvec3(0));
  expect_color(ground_below_ball(4.3), glm::dvec3(0.5));  // beyond the light
  expect_color(ground_below_ball(-1), glm::dvec3(0.5));   // below the ground
}

/// Each pixel's colour differs, so that a colour names a direction.
Background sky() {
  auto image = std::make_shared<Image>(64, 32, std::vector<std::string>{"R", "G", "B"});
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x) {
      float* p = image->pixel(x, y);
      p[0] = std::abs(static_cast<float>(x) - 31.5f), p[1] = static_cast<float>(y),
      p[2] = static_cast<float>((x + 16) % 64);
    }
  return {glm::vec3(0), image};
}

/// What the sky shows through (or in) the ground, whose material is given, for a ray at `angle` from the normal.
glm::vec3 sky_by_ground(const Material& material, double angle, double side) {
  GeometryBuilder builder;
  builder.add(ground);
  Scene scene = scene_of(builder, material, one_ray({-2 * std::sin(angle), 0, side * 2 * std::cos(angle)}, {0, 0, 0}));
  scene.background = sky();
  return seen(scene);
}

TEST(Render, AMirrorShowsTheMirroredDirection) {
  const Material mirror{.color = {1, 0, 0}, .diffuse = 0, .reflect = 0.75f};
  const Environment environment(sky());
  expect_color(sky_by_ground(mirror, 0.6, 1), 0.75f * environment({std::sin(0.6), 0, std::cos(0.6)}), 1e-4);
}

TEST(Render, GlassBendsRaysBySnellsLaw) {
  const Material glass{.color = {1, 0.5f, 1}, .diffuse = 0, .transmit = 0.5f, .ior = 1.5f};
  const Environment environment(sky());
  const double into = std::asin(std::sin(0.6) / 1.5), out = std::asin(std::sin(0.6) * 1.5);
  const glm::vec3 tint(0.5f, 0.25f, 0.5f);
  expect_color(sky_by_ground(glass, 0.6, 1), tint * environment({std::sin(into), 0, -std::cos(into)}), 1e-4);
  expect_color(sky_by_ground(glass, 0.6, -1), tint * environment({std::sin(out), 0, std::cos(out)}), 1e-4);
}

TEST(Render, BeyondTheCriticalAngleGlassIsAMirror) {
  const Material glass{.color = {1, 0.5f, 1}, .diffuse = 0, .reflect = 0.25f, .transmit = 0.5f, .ior = 1.5f};
  const Environment environment(sky());
  const glm::vec3 share(0.25f + 0.5f, 0.25f + 0.25f, 0.25f + 0.5f);
  expect_color(sky_by_ground(glass, 0.8, -1), share * environment({std::sin(0.8), 0, -std::cos(0.8)}), 1e-4);
}

TEST(Render, WithoutAnIndexLightPassesStraight) {
  const Environment environment(sky());
  for (float ior : {0.0f, 1.0f}) {
    const Material foil{.color = {1, 1, 1}, .diffuse = 0, .transmit = 1, .ior = ior};
    expect_color(sky_by_ground(foil, 0.6, 1), environment({std::sin(0.6), 0, -std::cos(0.6)}), 1e-4);
  }
}

/// Two mirrors that face each other, each glowing by 1.
double hall_of_mirrors(float reflect, int depth) {
  GeometryBuilder builder;
  builder.add(ground);
  builder.add(ground, 0, Affine::translate({0, 0, 1}));
  const Material mirror{.color = glm::vec3(1), .ambient = 1, .diffuse = 0, .reflect = reflect};
  return seen(scene_of(builder, mirror, one_ray({0, 0, 0.5}, {0, 0, 0})), {.depth = depth}).x;
}

TEST(Render, DepthCountsTheBouncesAfterThePrimaryRay) {
  EXPECT_FLOAT_EQ(hall_of_mirrors(0.5f, 0), 1);
  EXPECT_FLOAT_EQ(hall_of_mirrors(0.5f, 1), 1.5f);
  EXPECT_FLOAT_EQ(hall_of_mirrors(0.5f, 4), 1 + 0.5f + 0.25f + 0.125f + 0.0625f);
  EXPECT_FLOAT_EQ(hall_of_mirrors(1, 100), 101);
}

TEST(Render, RaysThatCannotBeSeenAreNotTraced) { EXPECT_FLOAT_EQ(hall_of_mirrors(0.5f, 40), 2 - 1 / 2048.0f); }

TEST(Render, BrightLightsShowOnDarkSurfaces) {
  Mesh triangle{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {}, {{0, 1, 2}}};
  GeometryBuilder builder;
  builder.add(triangle);
  Scene scene =
      scene_of(builder, {.color = glm::vec3(1), .ambient = 0, .diffuse = 1e-4f}, one_ray({0, -1, 3}, {0, 0, 0}));
  scene.lights = {point_light({0, 0, 2})};
  scene.lights[0].color = glm::vec3(1e4f);
  expect_color(seen(scene), glm::dvec3(1), 1e-5);
}

TEST(Render, InterpolatedNormalsShade) {
  Mesh triangle{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{-0.6f, 0, 0.8f}, {0.6f, 0, 0.8f}, {0, 0, 1}}, {{0, 1, 2}}};
  GeometryBuilder builder;
  builder.add(triangle);
  Scene scene = scene_of(builder, {.color = glm::vec3(1)}, one_ray({0.5, -1, 3}, {0.5, -1 + 1e-9, 0}));
  scene.lights = {point_light({0.5, -1, 2})};
  // Three quarters along the edge from the first to the second corner.
  const glm::dvec3 normal = glm::normalize(0.25 * glm::dvec3(-0.6, 0, 0.8) + 0.75 * glm::dvec3(0.6, 0, 0.8));
  expect_color(seen(scene, {.shading = Shading::direct}), glm::dvec3(normal.z), 1e-5);
}

TEST(Render, CountsItsRaysByKind) {
  GeometryBuilder builder;
  builder.add(ground);
  const Material material{.color = glm::vec3(1), .reflect = 0.5f, .transmit = 0.25f, .ior = 1};
  Scene scene = scene_of(builder, material, one_ray({0, -2, 1}, {0, 0, 0}));
  scene.camera.size = {6, 5};
  scene.camera.fov = 10;  // sees the ground alone
  scene.lights = {point_light({0, 0, 3}), point_light({0, 0, -3})};
  const RenderStats stats = render_with("embree", scene).stats;
  EXPECT_EQ(stats.rays, (std::array<std::uint64_t, 4>{30, 30, 30, 30}));  // one of the lights is behind the surface
  EXPECT_EQ(stats.invalid_rays, 0u);
  EXPECT_GT(stats.tracer_seconds, 0);
  EXPECT_GT(stats.shading_seconds, 0);
  EXPECT_GE(stats.seconds, stats.tracer_seconds / 64);
}

TEST(Render, RefusesImpossibleOrders) {
  const Scene good = lit_sphere();
  const auto tracer = make_tracer("embree", good.geometry);
  EXPECT_THROW(render(good, *tracer, {.depth = -1}), Error);
  EXPECT_THROW(render(good, *tracer, {.depth = 1 << 30}), Error);
  EXPECT_THROW(render(good, *tracer, {.spp = 0}), Error);
  EXPECT_THROW(render(good, *tracer, {.aovs = {Aov::depth, Aov::depth}}), Error);
  for (const glm::ivec2 size : {glm::ivec2(0, 4), glm::ivec2(4, -1), glm::ivec2(100000, 100000)}) {
    Scene bad = good;
    bad.camera.size = size;
    EXPECT_THROW(render(bad, *tracer), Error);
  }
}

TEST(Render, RefusesMaterialsThatAreNotThere) {
  GeometryBuilder group, builder;
  group.add(unit_sphere, 1);
  builder.add(group.build());
  Scene scene = scene_of(builder, {}, one_ray({0, -5, 0}, {0, 0, 0}));
  EXPECT_THROW(seen(scene), Error);
  scene.materials.resize(2);
  EXPECT_NO_THROW(seen(scene));
}

}  // namespace
}  // namespace rayengine::test
