// Pictures by Purcell's kernels against the renderer's own formulas on the oracle's hits.

#include "gpu/grid/grid_caster.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "accel/surface.h"
#include "cpu/reference_tracer.h"
#include "engine/render/camera.h"
#include "engine/render/cast.h"
#include "engine/render/optics.h"

namespace rayengine {
namespace {

/// A mirror ball, others, a wall of triangles and an endless floor under two lights, one without a place.
Scene balls() {
  GeometryBuilder builder;
  builder.add(QuadricShape{}, 1);
  builder.add(QuadricShape{QuadricType::cone, true, {}, {}, {}}, 0, Affine::translate({1.6, -1, -1}));
  builder.add(QuadricShape{QuadricType::general, false, {}, QuadricMatrix{1, .2, 0, 0, 2, 0, 0, 1.5, 0, -.3}, {}}, 0,
              Affine::translate({-1.4, -1, 0}));
  builder.add(Mesh{{{-3, 3, -1}, {3, 3, -1}, {3, 3, 4}, {-3, 3, 4}}, {}, {{0, 1, 2}, {0, 2, 3}}}, 2);
  builder.add(QuadricShape{QuadricType::plane, false, {}, {}, {}}, 2, Affine::translate({0, 0, -1}));
  Scene scene;
  scene.geometry = builder.build();
  scene.camera = {.from = {1, -5, 2}, .at = {0, 0, 0}, .up = {0, 0, 1}, .fov = 45, .size = {90, 60}};
  scene.background.color = {.1f, .2f, .3f};
  scene.lights = {{Light::Type::point, {4, -6, 8}, {}, {.9f, .8f, .7f}},
                  {Light::Type::directional, {}, {1, 1, -1}, {.2f, .2f, .3f}}};
  scene.materials = {{.color = {.8f, .2f, .1f}, .ambient = .1f, .diffuse = .8f, .specular = .5f, .shininess = 20},
                     {.color = {.1f, .3f, .9f}, .ambient = .05f, .diffuse = .4f, .reflect = .5f},
                     {.color = {.6f, .6f, .6f}, .ambient = .1f, .diffuse = .9f}};
  return scene;
}

/// What a ray sees where one ray at most goes on from each surface.
glm::vec3 seen(const Scene& scene, Tracer& tracer, const Ray& ray, const GridCastOptions& options, int generation) {
  Hit hit;
  tracer.closest({&ray, 1}, {&hit, 1}, RayClass::primary);
  if (!hit.hit()) return scene.background.color;
  const Surface surface = surface_at(*scene.geometry, ray, hit);
  const Material& m = scene.materials[surface.material];
  const glm::dvec3 view = -glm::normalize(ray.direction);
  const glm::dvec3 normal = glm::dot(surface.normal, view) < 0 ? -surface.normal : surface.normal;
  const glm::dvec3 from = surface.position + 1e-4 * normal;
  const bool mirrors = m.reflect > 0 && generation < options.reflections;
  glm::vec3 color = m.ambient * m.color;
  for (const Light& light : scene.lights) {
    const bool directional = light.type == Light::Type::directional;
    const glm::dvec3 way = directional ? -light.direction : light.position - from;
    if (!(glm::dot(way, normal) > 0)) continue;
    std::uint32_t hidden = 0;
    const Ray shadow{from, 0, way, directional ? infinity : 1};
    if (&light == &scene.lights[0] && options.shadows && !mirrors)
      tracer.any({&shadow, 1}, {&hidden, 1}, RayClass::shadow);
    if (hidden) continue;
    color += light.color * reflected_light(m, glm::vec3(normal), glm::vec3(glm::normalize(way)), glm::vec3(view));
  }
  if (!mirrors) return color;
  const Ray reflected{from, 0, glm::reflect(ray.direction, normal), infinity};
  return color + m.reflect * seen(scene, tracer, reflected, options, generation + 1);
}

std::vector<glm::vec3> cast(const Scene& scene, const GridCastOptions& options) {
  return GridCaster(scene.geometry, cast_lights(scene), cast_materials(scene), scene.background.color, options)
      .cast(cast_view(scene.camera));
}

/// Single precision may see another surface at outlines and at the borders of shadows.
void expect_picture(const GridCastOptions& options) {
  const Scene scene = balls();
  const auto oracle = make_reference_tracer(scene.geometry);
  const auto colors = cast(scene, options);
  const CameraFrame frame(scene.camera);
  std::size_t wrong = 0, i = 0;
  for (int y = 0; y < scene.camera.size.y; ++y)
    for (int x = 0; x < scene.camera.size.x; ++x) {
      const Ray ray{scene.camera.from, 0, frame.direction(x + .5, y + .5), infinity};
      const glm::vec3 difference = glm::abs(colors[i++] - seen(scene, *oracle, ray, options, 0));
      wrong += !(std::max({difference.x, difference.y, difference.z}) < 1e-3f);
    }
  EXPECT_LE(wrong, colors.size() / 200);
}

TEST(GridCaster, CastsEyeRays) { expect_picture({.shadows = false}); }
TEST(GridCaster, AsksAfterTheFirstLight) { expect_picture({}); }
TEST(GridCaster, SendsOneRayOnFromMirrors) { expect_picture({.reflections = 2}); }
TEST(GridCaster, DoesItInOnePass) { expect_picture({.tracer = {.policy = GridPolicy{.few = 1}}, .reflections = 2}); }

TEST(GridCaster, SeesTheSameFromAfar) {
  Scene scene = balls();
  scene.camera.from *= 200., scene.camera.fov /= 200;
  GeometryBuilder bounded;  // without the floor, as a frame is all that is seen from there
  bounded.add(QuadricShape{}, 1);
  scene.geometry = bounded.build();
  const auto colors = cast(scene, {});
  const auto middle = colors[colors.size() / 2 + static_cast<std::size_t>(scene.camera.size.x) / 2];
  EXPECT_GT(glm::length(middle - scene.background.color), .05f);
  EXPECT_EQ(colors[0], scene.background.color);
}

TEST(GridCaster, SaysWhatItsKernelsDid) {
  const Scene scene = balls();
  GridCaster caster(scene.geometry, cast_lights(scene), cast_materials(scene), scene.background.color, {});
  const GridWork work = caster.measure(cast_view(scene.camera));
  const auto rays = static_cast<std::size_t>(scene.camera.size.x * scene.camera.size.y);
  for (std::size_t i = 0; i < grid_state_count; ++i) {
    EXPECT_GT(work.passes[i], 0u);
    EXPECT_GT(work.watches[i].seconds().elapsed, 0);
  }
  EXPECT_GT(work.rays[0], rays);
  EXPECT_GT(work.rays[2], rays) << "eye rays, and those to the light";
  EXPECT_LE(work.rays[2], 2 * rays);
}

}  // namespace
}  // namespace rayengine
