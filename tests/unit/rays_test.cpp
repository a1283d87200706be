#include "engine/measure/rays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "cpu/reference_tracer.h"

namespace rayengine {
namespace {

bool same(const std::vector<Ray>& a, const std::vector<Ray>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Ray)) == 0;
}

std::vector<Hit> trace(const std::shared_ptr<const Geometry>& geometry, std::span<const Ray> rays) {
  std::vector<Hit> hits(rays.size());
  make_reference_tracer(geometry)->closest(rays, hits, RayClass::primary);
  return hits;
}

std::shared_ptr<const Geometry> unit_sphere() {
  GeometryBuilder builder;
  builder.add(QuadricShape{}, 0, Affine::translate({3, 0, 0}));
  return builder.build();
}

TEST(Rays, PrimaryRaysPassTheMiddleOfEveryPixel) {
  Camera camera;
  camera.from = {0, 0, 5}, camera.up = {0, 1, 0}, camera.fov = 90, camera.size = {4, 2};
  const auto rays = primary_rays(camera);
  ASSERT_EQ(rays.size(), 8u);
  const glm::dvec3 first = rays[0].direction / -rays[0].direction.z;
  EXPECT_NEAR(first.x, -1.5, 1e-12);
  EXPECT_NEAR(first.y, .5, 1e-12);
  EXPECT_NEAR(glm::length(rays[5].direction), 1, 1e-15);
}

TEST(Rays, RandomRaysStartOnTheSphereAboutTheBoundsAndAreRepeatable) {
  const Box box{{-1, 2, 3}, {1, 4, 9}};
  const auto rays = random_rays(box, 1000);
  for (const Ray& ray : rays) {
    EXPECT_NEAR(glm::length(ray.origin - box.center()), 0.5 * glm::length(box.size()), 1e-12);
    EXPECT_NEAR(glm::length(ray.direction), 1, 1e-14);
    EXPECT_LE(glm::dot(ray.direction, ray.origin - box.center()), 1e-12) << "goes inward";
  }
  EXPECT_TRUE(same(rays, random_rays(box, 1000)));
  EXPECT_FALSE(same(rays, random_rays(box, 1000, 2)));
  const auto unbounded = random_rays({glm::dvec3(-infinity), glm::dvec3(infinity)}, 10);
  EXPECT_TRUE(is_valid(unbounded[9]));
}

TEST(Rays, ShadowRaysEndAtTheirLight) {
  Scene scene;
  scene.geometry = unit_sphere();
  Light point, below, sun;
  point.position = {3, 0, 10};
  below.position = {3, 0, -10};
  sun.type = Light::Type::directional, sun.direction = {0, 0, -2};
  scene.lights = {point, below, sun};
  const std::vector<Ray> rays{{{3, 0, 5}, 0, {0, 0, -1}, infinity}, {{9, 0, 5}, 0, {0, 0, -1}, infinity}};
  const auto shadow = shadow_rays(scene, rays, trace(scene.geometry, rays));
  ASSERT_EQ(shadow.size(), 2u) << "one ray misses, and one light is behind";
  EXPECT_NEAR(glm::length(shadow[0].at(shadow[0].tmax) - point.position), 0, 1e-12);
  EXPECT_EQ(shadow[1].direction, glm::dvec3(0, 0, 2));
  EXPECT_EQ(shadow[1].tmax, infinity);
  for (const Ray& ray : shadow) EXPECT_GT(ray.at(ray.tmin).z, 1) << "starts outside";
  EXPECT_FALSE(trace(scene.geometry, shadow)[0].hit());
}

TEST(Rays, BouncesLeaveConvexBodiesForGood) {
  const auto geometry = unit_sphere();
  const auto rays = random_rays(geometry->bounds, 500);
  const auto hits = trace(geometry, rays);
  const auto bounces = bounce_rays(*geometry, rays, hits);
  ASSERT_GT(bounces.size(), 100u);
  EXPECT_TRUE(same(bounces, bounce_rays(*geometry, rays, hits)));
  double cosines = 0;
  for (const Ray& ray : bounces) cosines += glm::dot(ray.direction, glm::normalize(ray.origin - glm::dvec3(3, 0, 0)));
  EXPECT_NEAR(cosines / static_cast<double>(bounces.size()), 2. / 3, .05) << "the mean cosine of a diffuse surface";
  for (const Hit& hit : trace(geometry, bounces)) EXPECT_FALSE(hit.hit());
}

TEST(Rays, AimedRaysComeVeryNearToTheEdgeOfThings) {
  GeometryBuilder builder;
  builder.add(QuadricShape{});
  const auto ball = builder.build();
  const auto silhouettes = aimed_rays(*ball, 1000);
  int near = 0;
  for (const Ray& ray : silhouettes) near += std::abs(glm::length(glm::cross(ray.origin, ray.direction)) - 1) < 1e-14;
  EXPECT_GT(near, 400);
  EXPECT_TRUE(same(silhouettes, aimed_rays(*ball, 1000)));

  builder.add(Mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 1, 2}}});
  const auto triangle = builder.build();
  for (const Ray& ray : aimed_rays(*triangle, 100)) {
    const glm::dvec3 p = ray.at(-ray.origin.z / ray.direction.z);
    EXPECT_LT(std::min({std::abs(p.x), std::abs(p.y), std::abs(1 - p.x - p.y)}), 1e-12);
  }
  EXPECT_TRUE(aimed_rays(Geometry{}, 10).empty());
}

}  // namespace
}  // namespace rayengine
