// Pictures of glass, followed on the device, against paths followed by the renderer's optics on the processor.

#include "gpu/cones/glass_caster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "accel/surface.h"
#include "accel/tracer.h"
#include "engine/measure/rays.h"
#include "engine/measure/szecsi.h"
#include "engine/render/cast.h"
#include "engine/render/departure.h"
#include "engine/render/environment.h"
#include "engine/render/optics.h"
#include "engine/tracers.h"

namespace rayengine {
namespace {

using Method = GlassOptions::Method;

/// Smooth, and with its columns and rows told apart.
CastEnvironment sky() {
  CastEnvironment e{16, 8, {}};
  for (int y = 0; y < e.height; ++y)
    for (int x = 0; x < e.width; ++x)
      e.colors.push_back({static_cast<float>(y) / 8, static_cast<float>(std::abs(x - 8)) / 8, x % 4 < 2 ? .25f : .75f});
  return e;
}

Environment as_background(const CastEnvironment& e) {
  auto image = std::make_shared<Image>(e.width, e.height, std::vector<std::string>{"R", "G", "B"});
  for (int i = 0; i < e.width * e.height; ++i)
    for (int k = 0; k < 3; ++k)
      image->pixels[static_cast<std::size_t>(3 * i + k)] = e.colors[static_cast<std::size_t>(i)][k];
  Background background;
  background.image = image;
  return Environment(background);
}

/// The path's next direction, by the renderer's rules; see Waves::scatter.
glm::dvec3 scattered(const glm::dvec3& d, const Surface& s, float index) {
  const glm::dvec3 facing = glm::dot(s.shading_normal, d) > 0 ? -s.shading_normal : s.shading_normal;
  const auto same_side = [&](const glm::dvec3& a) { return glm::dot(a, s.normal) * glm::dot(d, s.normal) > 0; };
  if (index != 0)
    if (const auto through = refracted(d, facing, glm::dot(d, s.normal) < 0 ? 1. / index : index))
      return same_side(*through) ? *through : d;
  const glm::dvec3 back = reflected(d, facing);
  return same_side(back) ? reflected(d, s.normal) : back;
}

glm::vec3 followed(const Geometry& geometry, Tracer& tracer, const Environment& environment,
                   std::span<const float> indices, Ray ray, int length) {
  for (int i = 0; i < length; ++i) {
    Hit hit;
    tracer.closest({&ray, 1}, {&hit, 1}, RayClass::bounce);
    if (!hit.hit()) break;
    const Surface surface = surface_at(geometry, ray, hit);
    Departure departure;
    departure.set(surface, tracer.limits());
    departure.start(ray, glm::normalize(scattered(ray.direction, surface, indices[surface.material])), infinity);
  }
  return environment(ray.direction);
}

/// Single precision takes another way round edges now and then, and grazing rays far from where double takes them.
void expect_the_same_paths(const Scene& scene, std::span<const float> indices, const GlassOptions& options) {
  const auto colors = GlassCaster(scene.geometry, indices, sky(), options).cast(cast_view(scene.camera));
  const auto rays = primary_rays(scene.camera);
  const auto tracer = make_tracer("bvh", scene.geometry);
  const Environment environment = as_background(sky());
  std::size_t wrong = 0, bent = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const glm::vec3 exact = followed(*scene.geometry, *tracer, environment, indices, rays[i], options.path_length);
    const glm::vec3 difference = glm::abs(colors[i] - exact);
    wrong += !(std::max({difference.x, difference.y, difference.z}) < .01f);
    bent += glm::distance(exact, environment(rays[i].direction)) > .02f;
  }
  EXPECT_LT(wrong, rays.size() / 100);
  EXPECT_GT(bent, rays.size() / 8);
}

class Glass : public testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(Methods, Glass, testing::Values(Method::hierarchical, Method::ray_engine),
                         [](const auto& i) { return i.param == Method::hierarchical ? "hierarchical" : "ray_engine"; });

TEST_P(Glass, BendsRaysAsTheRendererDoes) {
  const float index = 1.5f;
  expect_the_same_paths(glass_bodies(200, 72), {&index, 1}, {.method = GetParam()});
}

/// A mirror behind an instanced piece of glass with flat faces, in a picture that is no whole number of tiles; and so
/// many generations that stencil bits run out.
TEST_P(Glass, MirrorsAndInstancesTakePart) {
  GeometryBuilder group, builder;
  group.add(Mesh{{{-1, 0, -1}, {1, 0, -1}, {0, .8, -1}, {0, .3, 1}}, {}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}},
            1);
  const auto prism = group.build();
  builder.add(prism, Affine::translate({.8, 0, 0}));
  builder.add(Mesh{{{-3, 2, -3}, {3, 2, -3}, {3, 2, 3}, {-3, 2, 3}}, {}, {{0, 1, 2}, {0, 2, 3}}}, 0);
  builder.add(Mesh{{{-3, -9, -3}, {3, -9, -3}, {3, -9, 3}, {-3, -9, 3}}, {}, {{0, 1, 2}, {0, 2, 3}}}, 0);
  builder.add(prism, Affine::translate({-.8, 0, 0}));
  Scene scene;
  scene.geometry = builder.build();
  scene.camera = {.from = {.1, -5, .2}, .fov = 40, .size = {75, 50}};
  const std::array indices{0.f, 1.4f};
  expect_the_same_paths(scene, indices, {.method = GetParam(), .path_length = 12});
}

TEST(GlassCaster, MethodsAgreeToTheBit) {
  const Scene scene = glass_bodies(300, 75);
  const float index = 1.5f;
  const CastView view = cast_view(scene.camera);
  const auto cast = [&](const GlassOptions& o) {
    return GlassCaster(scene.geometry, {&index, 1}, sky(), o).cast(view);
  };
  const auto expected = cast({});
  EXPECT_EQ(expected, cast({.method = Method::ray_engine}));
  EXPECT_EQ(expected, cast({.method = Method::ray_engine, .stride = 7}));
  EXPECT_EQ(expected, cast({.tile = 5}));
}

TEST(GlassCaster, ConesOpenFromGenerationToGeneration) {
  const Scene scene = glass_bodies(1000, 128);
  const float index = 1.5f;
  GlassCaster caster(scene.geometry, {&index, 1}, sky());
  const CastView view = cast_view(scene.camera);
  const auto camera = caster.openings(view, 1), bent = caster.openings(view, 4), last = caster.openings(view, 40);
  ASSERT_EQ(camera.size(), 64u);
  // From the first pixel to the last a tile is 15/128 of the view's height wide, its diagonal's half 0.028.
  EXPECT_GT(std::ranges::min(camera), .026f);
  EXPECT_LT(std::ranges::max(camera), .04f);
  EXPECT_GT(std::ranges::max(bent), 1.5f * std::ranges::max(camera));
  EXPECT_GT(std::ranges::count(last, -1.f), 32);
}

/// The point of it all. Goals and measured figures are in docs/szecsi.md; a goal missed by far shows here.
TEST(GlassCaster, ConesPay) {
  const Scene scene = glass_bodies(1000, 128);
  const float index = 1.5f;
  const CastView view = cast_view(scene.camera);
  GlassCaster cones(scene.geometry, {&index, 1}, sky());
  GlassCaster plain(scene.geometry, {&index, 1}, sky(), {.method = Method::ray_engine, .stride = 10});
  cones.time(view), plain.time(view);
  EXPECT_GT(plain.time(view).processor, 4 * cones.time(view).processor);
}

TEST(GlassCaster, RefusesWhatItCannotHold) {
  const float index = 1.5f;
  GeometryBuilder ball, glass;
  ball.add(QuadricShape{});
  EXPECT_THROW(GlassCaster(ball.build(), {&index, 1}, sky()), Error);
  glass.add(Mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 1, 2}}}, 2);
  const auto triangle = glass.build();
  EXPECT_THROW(GlassCaster(triangle, {&index, 1}, sky()), Error);
  const std::array indices{1.5f, 1.5f, 1.5f};
  EXPECT_THROW(GlassCaster(triangle, indices, {4, 4, {}}), Error);
  for (const GlassOptions& wrong :
       {GlassOptions{.tile = 0}, GlassOptions{.path_length = -1}, GlassOptions{.stride = 0}})
    EXPECT_THROW(GlassCaster(triangle, indices, sky(), wrong), Error);
  CastView view = cast_view(Camera{});
  view.width = 1 << 20;
  EXPECT_THROW(GlassCaster(triangle, indices, sky()).cast(view), Error);
}

}  // namespace
}  // namespace rayengine
