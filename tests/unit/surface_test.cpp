#include "accel/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "render_scenes.h"

// Hits worked out again, against the oracle's: every type of primitive, turned, stretched, far away, instanced.
namespace rayengine::test {
namespace {

const Affine stretched = Affine::translate({30, -20, 10}) * Affine::rotate({1, 2, 3}, 50) * Affine::scale({2, 0.5, 1});

struct Body {
  const char* name;
  std::shared_ptr<const Geometry> geometry;
};

QuadricShape shape_of(QuadricType type) {
  QuadricShape shape{.type = type};
  shape.capped = type >= QuadricType::cylinder && type <= QuadricType::hyperboloid2;
  if (type == QuadricType::general) {
    shape.matrix = QuadricMatrix{1, 0.2, 0.1, 0.05, 1.5, -0.1, 0, 0.8, 0.1, -1};
    shape.box = Box{{-2, -2, -2}, {2, 2, 2}};
  }
  return shape;
}

std::shared_ptr<const Geometry> instanced(std::shared_ptr<const Geometry> group) {
  GeometryBuilder builder;
  builder.add(std::move(group),
              Affine::translate({-5, 3, 2}) * Affine::rotate({0, 1, 1}, 20) * Affine::scale({1, 3, 2}));
  return builder.build();
}

std::vector<Body> bodies() {
  std::vector<Body> result;
  for (std::size_t i = 0; i < quadric_type_count; ++i) {
    const auto type = static_cast<QuadricType>(i);
    GeometryBuilder builder;
    builder.add(shape_of(type), 0, stretched);
    result.push_back({to_string(type).data(), builder.build()});
    result.push_back({to_string(type).data(), instanced(result.back().geometry)});
  }
  GeometryBuilder builder;
  builder.add(globe(9), 0, stretched);
  result.push_back({"mesh", builder.build()});
  result.push_back({"mesh", instanced(result.back().geometry)});
  return result;
}

/// Rays from far and near towards the middle of a body.
std::vector<Ray> rays_at(const Geometry& geometry) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const auto direction = [&] { return glm::dvec3(normal(random), normal(random), normal(random)); };
  const glm::dvec3 middle = geometry.bounds.finite() ? geometry.bounds.center() : glm::dvec3(30, -20, 10);
  std::vector<Ray> rays;
  for (int i = 0; i < 400; ++i) {
    const double distance = std::pow(10, i % 4);
    const glm::dvec3 from = middle + distance * direction();
    rays.push_back({from, 0, (middle + 0.6 * direction() - from) * (i % 3 + 0.5), infinity});
  }
  return rays;
}

TEST(Surface, AgreesWithTheOracleWithinItsBounds) {
  for (const Body& body : bodies()) {
    const std::vector<Ray> rays = rays_at(*body.geometry);
    std::vector<Hit> hits(rays.size());
    make_tracer("reference", body.geometry)->closest(rays, hits, RayClass::bounce);
    int checked = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (!hits[i].hit()) continue;
      ++checked;
      Hit rough = hits[i];
      rough.t = static_cast<float>(hits[i].t);
      const Hit refined = refine(*body.geometry, rays[i], rough);
      EXPECT_LE(std::abs(refined.t - hits[i].t), refined.error + 0x1p-52 * hits[i].t) << body.name << " ray " << i;
      EXPECT_LT(refined.error, 1e-9 * std::max(1.0, hits[i].t)) << body.name << " ray " << i;
      const Surface surface = surface_at(*body.geometry, rays[i], rough);
      const glm::dvec3 off = surface.position - rays[i].at(hits[i].t);
      EXPECT_LE(std::abs(glm::dot(off, surface.normal)), surface.error) << body.name << " ray " << i;
      EXPECT_NEAR(glm::dot(surface.normal, glm::dvec3(hits[i].normal)), 1, 1e-6) << body.name << " ray " << i;
      EXPECT_NEAR(glm::length(surface.normal), 1, 1e-15);
      EXPECT_EQ(refined.normal, glm::vec3(surface.normal));
      EXPECT_GE(surface.magnitude, glm::length(surface.position) / std::sqrt(3.0) * (1 - 1e-15));
    }
    EXPECT_GT(checked, 40) << body.name;
  }
}

/// So it does not matter who answered: a tracer in double, or one in single precision whose hits are worked out again.
TEST(Surface, RefinedHitsHaveTheBitsOfTracersInDouble) {
  std::vector<Body> all = bodies();
  for (const QuadricType type : {QuadricType::sphere, QuadricType::cylinder, QuadricType::cone}) {
    GeometryBuilder builder;
    builder.add(QuadricShape{.type = type}, 0, stretched);
    builder.add(QuadricShape{.type = type}, 0, Affine::translate({33, -20, 10}) * Affine::scale(glm::dvec3(0.7)));
    all.push_back({"open", builder.build()});
    all.push_back({"open", instanced(all.back().geometry)});
  }
  for (const Body& body : all) {
    if (body.name == std::string_view("mesh")) continue;  // triangles are refined by a formula of their own
    const std::vector<Ray> rays = rays_at(*body.geometry);
    std::vector<Hit> hits(rays.size());
    for (const char* name : {"bvh", "embree"}) {
      make_tracer(name, body.geometry)->closest(rays, hits, RayClass::bounce);
      int checked = 0;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].hit()) continue;
        ++checked;
        Hit rough = hits[i];
        rough.t = static_cast<float>(hits[i].t);
        EXPECT_EQ(refine(*body.geometry, rays[i], rough).t, hits[i].t) << name << ' ' << body.name << " ray " << i;
      }
      EXPECT_GT(checked, 40) << name << ' ' << body.name;
    }
  }
}

/// Meshes with normals, zero ones among them, and triangles that rays see edge-on or whose squares vanish.
std::vector<Body> odd_meshes() {
  std::vector<Body> result;
  for (const double size : {1.0, 1e-75, 1e75}) {
    Mesh mesh = globe(9);
    mesh.normals.resize(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.normals.size(); ++i)
      if (i % 3) mesh.normals[i] = glm::vec3(mesh.positions[i]) + glm::vec3(0.1f, 0, 0);
    for (glm::dvec3& p : mesh.positions) p *= size;
    GeometryBuilder builder;
    builder.add(mesh);
    builder.add(shape_of(QuadricType::cylinder), 1, Affine::scale(glm::dvec3(size)));
    result.push_back({"odd mesh", builder.build()});
  }
  return result;
}

TEST(Surface, ManyAtOnceAreTheSameAsOneByOne) {
  std::vector<Body> all = bodies();
  for (const Body& body : odd_meshes()) all.push_back(body);
  for (const Body& body : all) {
    std::vector<Ray> rays = rays_at(*body.geometry);
    for (Ray& ray : rays) {
      const double size = body.geometry->bounds.finite() ? body.geometry->bounds.extent() : 1;
      if (size < 1e-9 || size > 1e9) ray.origin *= size / 10, ray.direction *= size / 10;
    }
    std::vector<Hit> hits(rays.size());
    make_tracer("bvh", body.geometry)->closest(rays, hits, RayClass::bounce);
    std::vector<Surface> surfaces(rays.size());
    surfaces_at(*body.geometry, rays, hits, surfaces);
    int checked = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (!hits[i].hit()) continue;
      ++checked;
      const Surface one = surface_at(*body.geometry, rays[i], hits[i]), &many = surfaces[i];
      EXPECT_EQ(many.position, one.position) << body.name << " ray " << i;
      EXPECT_EQ(many.normal, one.normal) << body.name << " ray " << i;
      EXPECT_EQ(many.shading_normal, one.shading_normal) << body.name << " ray " << i;
      EXPECT_EQ(many.error, one.error) << body.name << " ray " << i;
      EXPECT_EQ(many.magnitude, one.magnitude) << body.name << " ray " << i;
      EXPECT_EQ(many.spread, one.spread) << body.name << " ray " << i;
      EXPECT_EQ(many.material, one.material) << body.name << " ray " << i;
      EXPECT_EQ(many.is_triangle, one.is_triangle) << body.name << " ray " << i;
    }
    EXPECT_GT(checked, 40) << body.name;
  }
}

TEST(Surface, EdgeOnIsOneByOneAmongMany) {
  GeometryBuilder builder;
  builder.add(Mesh{{{0, 0, 0}, {3, 0, 0}, {0, 4, 0}}, {}, {{0, 1, 2}}});
  const auto geometry = builder.build();
  const std::vector<Ray> rays{{{0.5, 0.5, 3}, 0, {0, 0, -1}, infinity}, {{-3, 0.5, 0}, 0, {1, 0, 0}, infinity}};
  const Hit hit{.t = 3.25, .object = 0, .primitive = 0, .status = status_hit};
  std::vector<Surface> surfaces(2);
  surfaces_at(*geometry, rays, std::vector<Hit>{hit, hit}, surfaces);
  EXPECT_EQ(surfaces[0].position, glm::dvec3(0.5, 0.5, 0));
  EXPECT_EQ(surfaces[1].position, glm::dvec3(0.25, 0.5, 0));
}

TEST(Surface, SpreadIsTheDiameterOfTheCircleThroughTheCorners) {
  // A right angle's circle has the longest edge for its diameter.
  GeometryBuilder builder;
  builder.add(Mesh{{{0, 0, 0}, {3, 0, 0}, {0, 4, 0}}, {}, {{0, 1, 2}}});
  const auto group = builder.build();
  builder.add(group, Affine::translate({7, 0, 0}) * Affine::scale(glm::dvec3(2)));
  const auto placed = builder.build();
  const Ray ray{{0.5, 0.5, 3}, 0, {0, 0, -1}, infinity}, placed_ray{{8, 1, 3}, 0, {0, 0, -1}, infinity};
  const Hit hit{.t = 3, .object = 0, .primitive = 0, .status = status_hit};
  EXPECT_DOUBLE_EQ(surface_at(*group, ray, hit).spread, 5);
  EXPECT_DOUBLE_EQ(surface_at(*group, ray, hit).magnitude, 4);
  EXPECT_DOUBLE_EQ(surface_at(*placed, placed_ray, hit).spread, 10);
  EXPECT_GE(surface_at(*placed, placed_ray, hit).magnitude, 8);
}

TEST(Surface, NormalsThatCancelGiveTheFlatOne) {
  GeometryBuilder builder;
  builder.add(Mesh{{{0, 0, 0}, {3, 0, 0}, {0, 4, 0}}, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {{0, 1, 2}}});
  const Ray ray{{0.5, 0.5, 3}, 0, {0, 0, -1}, infinity};
  const Hit hit{.t = 3, .object = 0, .primitive = 0, .status = status_hit};
  EXPECT_EQ(surface_at(*builder.build(), ray, hit).shading_normal, glm::dvec3(0, 0, 1));
}

}  // namespace
}  // namespace rayengine::test
