// Pictures shaded on the device against the renderer's own formulas on the oracle's hits.

#include "gpu/objects/ray_caster.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "accel/tracer.h"
#include "cpu/reference_tracer.h"
#include "engine/measure/rays.h"
#include "engine/render/optics.h"

namespace rayengine {
namespace {

const std::vector<CastLight> lights{{{4, -6, 8}, false, {.9f, .8f, .7f}}, {{1, 1, -1}, true, {.2f, .2f, .3f}}};
const std::vector<CastMaterial> materials{{{.8f, .2f, .1f}, .1f, .8f, .5f, 20}, {{.1f, .3f, .9f}, .05f, .9f, 0, 1}};

Material material(const CastMaterial& m) {
  return {
      .color = m.color, .ambient = m.ambient, .diffuse = m.diffuse, .specular = m.specular, .shininess = m.shininess};
}

/// What a ray sees by the renderer's formulas, without shadows.
glm::vec4 expected(const Geometry& geometry, const Ray& ray, const Hit& hit) {
  if (!hit.hit()) return glm::vec4(0);
  const Material m = material(materials[geometry.objects[hit.object].material]);
  const glm::vec3 view(-glm::normalize(ray.direction));
  const glm::vec3 normal = glm::dot(hit.normal, view) < 0 ? -hit.normal : hit.normal;
  glm::vec3 color = m.ambient * m.color;
  for (const CastLight& light : lights) {
    const glm::vec3 to_light(glm::normalize(light.directional ? -light.position : light.position - ray.at(hit.t)));
    if (glm::dot(normal, to_light) > 0) color += light.color * reflected_light(m, normal, to_light, view);
  }
  return {color, 1};
}

/// Pictures may differ at outlines, where halves see another surface.
void expect_same_picture(const std::shared_ptr<const Geometry>& geometry, const Camera& camera) {
  const std::vector<Ray> rays = primary_rays(camera);
  const std::vector<glm::vec4> colors = RayCaster(geometry, lights, materials).cast(rays);
  std::vector<Hit> hits(rays.size());
  make_reference_tracer(geometry)->closest(rays, hits, RayClass::primary);
  std::size_t seen = 0, wrong = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const glm::vec4 difference = glm::abs(colors[i] - expected(*geometry, rays[i], hits[i]));
    wrong += std::max({difference.x, difference.y, difference.z, difference.w}) > .02f;
    seen += hits[i].hit();
  }
  EXPECT_GT(seen, rays.size() / 8);
  EXPECT_LT(wrong, rays.size() / 50);
}

Camera camera_at(const glm::dvec3& from) {
  Camera camera;
  camera.from = from, camera.at = {0, 0, .3}, camera.size = {96, 96};
  return camera;
}

/// The unit primitives of the paper's pictures, and our others.
class CastQuadric : public testing::TestWithParam<QuadricType> {};
INSTANTIATE_TEST_SUITE_P(Types, CastQuadric,
                         testing::Values(QuadricType::sphere, QuadricType::cylinder, QuadricType::cone,
                                         QuadricType::paraboloid, QuadricType::hyperboloid1, QuadricType::hyperboloid2,
                                         QuadricType::saddle, QuadricType::disk),
                         [](const auto& info) { return std::string(to_string(info.param)); });

TEST_P(CastQuadric, IsShadedAsTheRendererDoes) {
  GeometryBuilder builder;
  builder.add(QuadricShape{GetParam(), false, {}, {}, {}}, 0, Affine::rotate({1, 0, 0}, 20));
  expect_same_picture(builder.build(), camera_at({1, -4, 2}));
}

void add_flake(GeometryBuilder& builder, const glm::dvec3& center, double radius, int depth) {
  builder.add(QuadricShape{}, static_cast<std::uint32_t>(depth % 2),
              Affine::translate(center) * Affine::scale(glm::dvec3(radius)));
  if (depth == 0) return;
  for (int i = 0; i < 9; ++i) {
    const double around = .7 * i, up = i % 3 - 1;
    const glm::dvec3 way = glm::normalize(glm::dvec3(std::cos(around), std::sin(around), up));
    add_flake(builder, center + 4. / 3 * radius * way, radius / 3, depth - 1);
  }
}

TEST(RayCaster, ShadesASphereflakeAndTriangles) {
  GeometryBuilder builder;
  add_flake(builder, {0, 0, 0}, .9, 2);
  builder.add(Mesh{{{-9, -9, -1.5}, {9, -9, -1.5}, {0, 9, -1.5}}, {}, {{0, 1, 2}}}, 1);
  expect_same_picture(builder.build(), camera_at({1, -4, 2}));
}

TEST(RayCaster, SeesNothingAlongInvalidRays) {
  GeometryBuilder builder;
  builder.add(QuadricShape{});
  const std::vector<Ray> rays{
      {{0, 0, -4}, 0, {0, 0, 0}, 9}, {{0, 0, -4}, 0, {0, 0, 1}, 9}, {{0, 0, -4}, 0, {0, 0, 1}, 2}};
  const auto colors = RayCaster(builder.build(), lights, materials).cast(rays);
  EXPECT_EQ(colors[0], glm::vec4(0));
  EXPECT_EQ(colors[1].w, 1);
  EXPECT_EQ(colors[2], glm::vec4(0));
}

TEST(RayCaster, RefusesAMaterialThatIsNotThere) {
  GeometryBuilder builder;
  builder.add(QuadricShape{}, 2);
  EXPECT_THROW(RayCaster(builder.build(), lights, materials), Error);
}

}  // namespace
}  // namespace rayengine
