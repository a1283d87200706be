#include "engine/render/departure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render_scenes.h"

// No surface may shade itself by rounding, at any scale and place.
namespace rayengine::test {
namespace {

struct Place {
  double scale, offset;
  Affine map() const {
    return Affine::translate(glm::dvec3(offset, -0.7 * offset, 0.3 * offset)) * Affine::scale(glm::dvec3(scale));
  }
};
constexpr Place places[]{{1e-6, 0}, {1, 0}, {1e6, 0}, {1, 1e5}, {1e-2, 100}};

/// The shapes under test: exact and tessellated balls, and the latter as an instance.
enum class Body { sphere, mesh, instance };
constexpr Body bodies[]{Body::sphere, Body::mesh, Body::instance};

std::shared_ptr<const Geometry> geometry_of(Body body, const Affine& map) {
  GeometryBuilder builder;
  if (body == Body::sphere) builder.add(unit_sphere, 0, map);
  if (body == Body::mesh) builder.add(globe(60), 0, map);
  if (body == Body::instance) {
    GeometryBuilder group;
    group.add(globe(60));
    builder.add(group.build(), map);
  }
  return builder.build();
}

/// A picture of the body from `from`, with a light at `light`, both in the body's own units.
RenderResult picture(Body body, const Place& place, const Material& material, const glm::dvec3& from,
                     const glm::dvec3& light) {
  Scene scene;
  const Affine map = place.map();
  scene.geometry = geometry_of(body, map);
  scene.materials = {material};
  scene.background.color = glm::vec3(1);
  scene.lights = {point_light(map.point(light))};
  scene.camera = {.from = map.point(from), .at = map.point({0, 0.1, 0.05}), .fov = 40, .size = {120, 120}};
  return render_with("embree", scene, {.aovs = {Aov::normal, Aov::object, Aov::position}});
}

std::string describe(const Place& place, Body body) {
  return "scale " + std::to_string(place.scale) + ", offset " + std::to_string(place.offset) + ", body " +
         std::to_string(static_cast<int>(body));
}

struct Count {
  int lit = 0, dark = 0;
};

/// Of the pixels that show the body where it faces the light by more than `slack`: how many are lit, and how many dark.
Count count(const RenderResult& result, const glm::dvec3& light, const glm::dvec3& eye, double slack) {
  Count count;
  for (std::size_t i = 0; i < result.image.pixels.size(); i += result.image.channels.size()) {
    const float* p = &result.image.pixels[i];
    if (p[7] != 0) continue;
    glm::dvec3 normal(p[4], p[5], p[6]);
    const glm::dvec3 position(p[8], p[9], p[10]);
    if (glm::dot(normal, eye - position) < 0) normal = -normal;
    if (glm::dot(normal, glm::normalize(light - position)) > slack) ++(p[0] > 0 ? count.lit : count.dark);
  }
  return count;
}

TEST(Departure, NoBodyShadowsItself) {
  const Material white{.color = glm::vec3(1)};
  const glm::dvec3 light(5, -4, 3), eye(0.5, -3.5, 0.7);
  for (const Place& place : places)
    for (const Body body : bodies) {
      const Affine map = place.map();
      const Count c = count(picture(body, place, white, eye, light), map.point(light), map.point(eye), 0.001);
      EXPECT_GT(c.lit, 4000);
      EXPECT_EQ(c.dark, 0) << "scale " << place.scale << " offset " << place.offset << " body "
                           << static_cast<int>(body);
    }
}

TEST(Departure, NoRoomShadowsItself) {
  const Material white{.color = glm::vec3(1)};
  const glm::dvec3 light(0.2, -0.1, 0.1), eye(0.1, -0.8, 0.1);
  for (const Place& place : places)
    for (const Body body : bodies) {
      const Affine map = place.map();
      const Count c = count(picture(body, place, white, eye, light), map.point(light), map.point(eye), 0.001);
      EXPECT_EQ(c.lit, 120 * 120);
      EXPECT_EQ(c.dark, 0) << "scale " << place.scale << " offset " << place.offset << " body "
                           << static_cast<int>(body);
    }
}

/// Pixels whose colour is not the background's.
int not_white(const RenderResult& result) {
  int count = 0;
  for (std::size_t i = 0; i < result.image.pixels.size(); i += result.image.channels.size())
    count += result.image.pixels[i] != 1;
  return count;
}

/// Where a float's steps show beside the body itself, its rounded silhouette may face away from the eye.
int silhouette_slack(const Place& place) { return place.offset > 1e4 * place.scale ? 120 : 0; }

TEST(Departure, NoMirrorSeesItselfFromOutside) {
  const Material mirror{.color = glm::vec3(0), .diffuse = 0, .reflect = 1};
  for (const Place& place : places)
    for (const Body body : bodies) {
      const RenderResult result = picture(body, place, mirror, {0.5, -3.5, 0.7}, {0, 0, 9});
      EXPECT_LE(not_white(result), silhouette_slack(place)) << describe(place, body);
      EXPECT_GT(result.stats.rays[2], 7000u) << describe(place, body);
    }
}

TEST(Departure, RaysPassThroughBothWallsOfABody) {
  const Material foil{.color = glm::vec3(1), .diffuse = 0, .transmit = 1, .ior = 1};
  for (const Place& place : places)
    for (const Body body : bodies) {
      const RenderResult result = picture(body, place, foil, {0.5, -3.5, 0.7}, {0, 0, 9});
      int shown = 0;
      for (std::size_t i = 0; i < result.image.pixels.size(); i += result.image.channels.size())
        shown += result.image.pixels[i + 7] == 0;
      EXPECT_EQ(not_white(result), 0);
      // One ray into the body and one out of it, but for the silhouette, where it is thinner than the clearance.
      EXPECT_NEAR(static_cast<double>(result.stats.rays[3]), 2.0 * shown, 10 + 40 * silhouette_slack(place))
          << describe(place, body);
    }
}

/// A flat square of side 2 cut into rows of obtuse triangles, `height` high on a base of 1.
Mesh slivers(double height) {
  Mesh mesh;
  const int rows = static_cast<int>(2 / height);
  for (int row = 0; row <= rows; ++row)
    for (int i = 0; i < 4; ++i) mesh.positions.emplace_back(-1.5 + i + 0.5 * (row % 2), -1 + row * height, 0);
  for (int row = 0; row < rows; ++row)
    for (int i = 0; i < 3; ++i) {
      const auto below = static_cast<std::uint32_t>(4 * row + i), above = below + 4;
      const std::uint32_t apex = row % 2;
      mesh.triangles.emplace_back(below, below + 1, above + apex);
      mesh.triangles.emplace_back(above, above + 1, below + 1 - apex);
    }
  for (std::size_t i = 1; i < mesh.triangles.size(); i += 2) std::swap(mesh.triangles[i].y, mesh.triangles[i].z);
  return mesh;
}

TEST(Departure, NoSliverShadowsAnother) {
  for (const Place& place : places) {
    if (place.offset * 0x1p-24 > place.scale * 0.002) continue;  // there single precision makes them overlap
    const Affine map = place.map() * Affine::rotate({1, 2, 3}, 40);
    GeometryBuilder builder;
    builder.add(slivers(0.004), 0, map);
    Scene scene = scene_of(builder, {.color = glm::vec3(1)}, {});
    scene.camera = {.from = map.point({0.1, -0.2, 1}), .at = map.point({0, 0, 0}), .fov = 60, .size = {120, 120}};
    scene.lights = {point_light(map.point({0.5, 0.3, 0.6}))};
    const RenderResult result = render_with("embree", scene);
    int dark = 0;
    for (std::size_t i = 0; i < result.image.pixels.size(); i += 4) dark += result.image.pixels[i] == 0;
    EXPECT_EQ(dark, 0) << "scale " << place.scale << ", offset " << place.offset;
  }
}

}  // namespace
}  // namespace rayengine::test
