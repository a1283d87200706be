#include <cmath>
#include <glm/geometric.hpp>

#include "engine/load/load.h"
#include "engine/load/nff_cone.h"
#include "tests/data.h"
#include "tests/load/loading.h"

namespace rayengine {
namespace {

constexpr const char* a_view = "v from 0 0 5 at 0 0 0 up 0 1 0 angle 40 hither 0 resolution 64 32\n";

class Nff : public test::LoaderTest {
 protected:
  Nff() : LoaderTest(load_nff, "scene.nff") {}
};

TEST_F(Nff, IsAStreamOfWordsNotOfLines) {
  const Scene scene =
      load(std::string("# a comment\n") + a_view +
           "b .1 .2 .3 l 1 2 3 l 4 5 6 1 0.5 0.25 # another\nf 1 0\n0 .5 .25 10 0 0\ns 0 0 0\n2 c 0 0 0 1\n\n0 0 1 "
           "+1 p 3 0 0 0 1 0 0 0 1 0 #end");
  EXPECT_EQ(scene.background.color, glm::vec3(.1f, .2f, .3f));
  EXPECT_EQ(scene.camera.size, glm::ivec2(64, 32));
  EXPECT_EQ(scene.camera.from, glm::dvec3(0, 0, 5));
  EXPECT_EQ(scene.camera.fov, 40);
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.lights[0].color, glm::vec3(1 / std::sqrt(2.f)));
  EXPECT_EQ(scene.lights[1].color, glm::vec3(1, 0.5, 0.25));
  ASSERT_EQ(scene.geometry->objects.size(), 3u);
  EXPECT_EQ(scene.geometry->quadrics.size(), 2u);
  EXPECT_EQ(scene.geometry->triangles.size(), 1u);
  EXPECT_TRUE(scene.notes.empty());
}

TEST_F(Nff, MaterialsAreTheSameWhenTheirNumbersAre) {
  const Scene scene = load(
      "f 1 0 0 .5 .25 10 0 0 s 0 0 0 1\nf 0 1 0 1 0 100000 .5 1.5 s 3 0 0 1\nf 1 0 0 .5 .25 10 0 0 s 6 0 0 1 s 9 0 0 "
      "1");
  ASSERT_EQ(scene.materials.size(), 2u);
  const auto& objects = scene.geometry->objects;
  EXPECT_EQ(objects[0].material, 0u);
  EXPECT_EQ(objects[1].material, 1u);
  EXPECT_EQ(objects[2].material, 0u);
  EXPECT_EQ(objects[3].material, 0u);
  const Material& shiny = scene.materials[0];
  EXPECT_EQ(shiny.color, glm::vec3(1, 0, 0));
  EXPECT_EQ(shiny.diffuse, .5f);
  EXPECT_EQ(shiny.specular, .25f);
  EXPECT_EQ(shiny.shininess, 40);
  EXPECT_EQ(shiny.reflect, .25f);
  EXPECT_EQ(shiny.ior, 1);
  EXPECT_EQ(scene.materials[1].specular, 0);
  EXPECT_EQ(scene.materials[1].transmit, .5f);
  EXPECT_EQ(scene.materials[1].ior, 1.5f);
}

TEST_F(Nff, AnObjectBeforeAnyMaterialHasTheDefault) {
  const Scene scene = load("s 0 0 0 1 f 1 0 0 1 0 0 0 0 s 3 0 0 1");
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[0].color, Material{}.color);
  EXPECT_EQ(scene.geometry->objects[1].material, 1u);
}

TEST_F(Nff, WithoutCameraAndLightItGetsBothAndSaysSo) {
  const Scene scene = load("s 10 0 0 1");
  EXPECT_EQ(scene.camera.at, glm::dvec3(10, 0, 0));
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].position, scene.camera.from);
  EXPECT_EQ(scene.lights[0].color, glm::vec3(1));
  ASSERT_EQ(scene.notes.size(), 2u);
  EXPECT_NE(scene.notes[0].find("no camera"), std::string::npos);
  EXPECT_NE(scene.notes[1].find("no light"), std::string::npos);
}

TEST_F(Nff, AWordOfHowFinelyToFacetChangesNothing) {
  EXPECT_EQ(load("tess 4 s 0 0 0 1 tess 2 s 1 0 0 1").geometry->quadrics.size(), 2u);
}

TEST_F(Nff, ASevenNumberMaterialIsPlainWhenOpaque) {
  EXPECT_EQ(load("f 1 1 1 .5 .5 10 0 s 0 0 0 1").materials[0].reflect, .5f);
  EXPECT_EQ(error("s 0 0 0 1\nf 1 1 1 .5 .5 10 .5\ns 0 0 0 1"),
            "scene.nff:2: a transparent material has 7 numbers; give its index of refraction, the eighth");
}

TEST_F(Nff, ATextureIsLeftOutAndSaidSo) {
  const Scene scene = load(std::string(a_view) + "l 1 1 1 f 1 1 1 1 0 0 0 1 wood.jpg\ns 0 0 0 1");
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_TRUE(scene.notes[0].ends_with("scene.nff:2: texture 'wood.jpg' is left out")) << scene.notes[0];
}

TEST_F(Nff, PatchesKeepTheirNormals) {
  const Scene scene = load("pp 4 0 0 0 0 0 1 1 0 0 0 1 0 1 1 0 0 0 2 0 1 0 0 0 0 p 3 0 0 1 1 0 1 0 1 1");
  const Geometry& geometry = *scene.geometry;
  ASSERT_EQ(geometry.triangles.size(), 3u);
  EXPECT_EQ(geometry.normals[1], glm::vec3(0, 1, 0));
  EXPECT_EQ(geometry.normals[2], glm::vec3(0, 0, 1));
  EXPECT_EQ(geometry.normals[3], glm::vec3(0));
  EXPECT_EQ(geometry.normals[4], glm::vec3(0));
  EXPECT_EQ(geometry.objects[1].first_primitive, 2u);
}

TEST_F(Nff, ConcavePolygonsAreCutWithoutCoveringTheirNotch) {
  const Scene scene = load("p 4 0 0 0 1 -1 0 0 1 0 -1 -1 0");
  const Geometry& geometry = *scene.geometry;
  double area = 0;
  for (const glm::uvec3& t : geometry.triangles)
    area += glm::length(
                glm::cross(geometry.vertex(t.y) - geometry.vertex(t.x), geometry.vertex(t.z) - geometry.vertex(t.x))) /
            2;
  EXPECT_DOUBLE_EQ(area, 1);
}

/// The value of the quadric's form at a world point; zero on the surface.
double form(const PlacedQuadric& q, const glm::dvec3& world) {
  const glm::dvec3 p = inverse(q.to_world).point(world);
  const auto& [A, B, C, D, E, F, G, H, I, J] = q.shape.matrix.value_or(unit_matrix(q.shape.type));
  return A * p.x * p.x + E * p.y * p.y + H * p.z * p.z + 2 * (B * p.x * p.y + C * p.x * p.z + F * p.y * p.z) +
         2 * (D * p.x + G * p.y + I * p.z) + J;
}

/// The z of a world point in the quadric's object space, and the range that is kept of it.
void expect_between_circles(const glm::dvec3& base, double r0, const glm::dvec3& apex, double r1, QuadricType type) {
  const PlacedQuadric q = frustum(base, r0, apex, r1);
  EXPECT_EQ(q.shape.type, type);
  const glm::dvec3 axis = glm::normalize(apex - base);
  const glm::dvec3 across = glm::normalize(glm::cross(axis, glm::dvec3(0.3, -0.4, 0.86)));
  for (const double s : {0.0, 0.25, 1.0}) {
    const double radius = std::abs(r0 + s * (r1 - r0));
    EXPECT_NEAR(form(q, base + s * (apex - base) + radius * across), 0, 1e-12);
  }
  const std::array<double, 2> range = q.shape.box    ? std::array{q.shape.box->lower.z, q.shape.box->upper.z}
                                      : q.shape.clip ? *q.shape.clip
                                                     : std::array{0.0, 1.0};
  const double z0 = inverse(q.to_world).point(base).z, z1 = inverse(q.to_world).point(apex).z;
  EXPECT_NEAR(std::min(z0, z1), range[0], 1e-12);
  EXPECT_NEAR(std::max(z0, z1), range[1], 1e-12);
  EXPECT_GT(glm::determinant(q.to_world.linear), 0);
}

TEST(NffCone, StandsBetweenItsCircles) {
  const glm::dvec3 base(1, 2, 3), apex(-1, 0.5, 7);
  expect_between_circles(base, 0.5, apex, 0.5, QuadricType::cylinder);
  expect_between_circles(base, -0.5, apex, -0.5, QuadricType::cylinder);
  expect_between_circles(base, 0.5, apex, 0.1, QuadricType::cone);
  expect_between_circles(base, 0.1, apex, 0.5, QuadricType::cone);
  expect_between_circles(base, 0.5, apex, 0, QuadricType::cone);
  expect_between_circles(base, 0.5, apex, 0.4999999, QuadricType::general);
  expect_between_circles(base, 0.4999999, apex, 0.5, QuadricType::general);
}

TEST_F(Nff, BadInputIsRefusedWithItsLine) {
  EXPECT_EQ(error("s 0 0 0 1\nq 1 2 3"), "scene.nff:2: 'q' is no entity of NFF; use v, b, l, f, s, c, p or pp");
  EXPECT_EQ(error("\n\ns 0 0\nx 1"), "scene.nff:4: expected a number, found 'x'");
  EXPECT_EQ(error("s 0 0 0 1x"), "scene.nff:1: expected a number, found '1x'");
  EXPECT_EQ(error("s 0 0 0 nan"), "scene.nff:1: 'nan' is not a finite number");
  EXPECT_EQ(error("s 0 0 -inf 1"), "scene.nff:1: '-inf' is not a finite number");
  EXPECT_EQ(error("s 0 0 0 1e999"), "scene.nff:1: '1e999' is not a finite number");
  EXPECT_EQ(error("s 0 0 0\n"), "scene.nff:2: the file ends too early; is it complete?");
  EXPECT_EQ(error("s 0 0 0 0"), "scene.nff:1: a sphere has no radius; give it one");
  EXPECT_EQ(error("s 1e300 0 0 1e-300"),
            "scene.nff:1: a transform is singular or not finite: it must map space one to one");
  EXPECT_EQ(error("\nc 0 0 0 1 0 0 0 1"), "scene.nff:2: a cone has no height; its two ends must differ");
  EXPECT_EQ(error("\nc 0 0 0 1 0 0 1 -1"), "scene.nff:2: the radii of a cone have different signs; give both the same");
  EXPECT_EQ(error("\nc 0 0 0 0 0 0 1 0"), "scene.nff:2: a cone has no radius; give it one");
  EXPECT_EQ(error("p 2 0 0 0 1 0 0"), "scene.nff:1: a polygon has 2 vertices; it needs at least 3");
  EXPECT_EQ(error("p -7"), "scene.nff:1: a polygon has -7 vertices; it needs at least 3");
  EXPECT_EQ(error("p 3.5"), "scene.nff:1: expected a whole number, found '3.5'");
  EXPECT_EQ(error("p 999999999 0 0 0 1 0 0"), "scene.nff:1: the file ends too early; is it complete?");
  EXPECT_EQ(error("pp 99999999999999999999"), "scene.nff:1: expected a whole number, found '99999999999999999999'");
  EXPECT_EQ(error("f 1 1 1 1 1 1"), "scene.nff:1: the file ends too early; is it complete?");
  EXPECT_EQ(error("f 1 1 1 -1 1 1 0 0"), "scene.nff:1: a factor is negative or too large");
  EXPECT_EQ(error("f 1 1 1 1 1 1 1e39 0"), "scene.nff:1: a factor is negative or too large");
  EXPECT_EQ(error("b 1 1 -1"), "scene.nff:1: a factor is negative or too large");
  EXPECT_EQ(error("f wood.jpg"), "scene.nff:1: expected a number, found 'wood.jpg'");
  EXPECT_EQ(error("s 0 0 0 1\ntet 0 0 0 1"),
            "scene.nff:2: 'tet' is not of standard NFF; give its faces as polygons (p)");
  EXPECT_EQ(error("v\nfrom 0 0 1 up 0 1 0 angle 45"), "scene.nff:1: a viewpoint lacks 'from' or 'at'; give both");
  EXPECT_EQ(error("v from 0 0 1 at 0 0 1"),
            "scene.nff:1: the camera stands where it looks; 'from' and 'at' must differ");
  EXPECT_EQ(error("v from 0 0 1 at 0 0 0 up 0 0 2"),
            "scene.nff:1: the camera's up is zero or along its view; turn it away");
  EXPECT_EQ(error("v from 0 0 1 at 0 0 0 up 0 1 0 angle 180"),
            "scene.nff:1: the camera's angle is out of range; it must lie between 0 and 180 degrees");
  EXPECT_EQ(error("v from 0 0 1 at 0 0 0 up 0 1 0 angle 45 resolution 0 0"),
            "scene.nff:1: the picture's size is out of range; each side takes 1 to 65536 pixels");
  EXPECT_EQ(error(std::string(a_view) + a_view), "scene.nff:2: a second viewpoint; keep one");
  EXPECT_EQ(error(std::string(100, 'x')),
            "scene.nff:1: '" + std::string(24, 'x') + "...' is no entity of NFF; use v, b, l, f, s, c, p or pp");
  EXPECT_EQ(error(std::string_view("s\0\x1b 0", 5)),
            "scene.nff:1: 's?\?' is no entity of NFF; use v, b, l, f, s, c, p or pp");
}

struct Counts {
  const char* file;
  std::size_t quadrics, objects, triangles, lights, materials;
};

void PrintTo(const Counts& counts, std::ostream* out) { *out << counts.file; }

class NffData : public testing::TestWithParam<Counts> {};

TEST_P(NffData, HasWhatItsMakersCount) {
  const Counts& expected = GetParam();
  DATA_OR_SKIP(file, expected.file);
  const Scene scene = load_nff(file);
  EXPECT_EQ(scene.geometry->quadrics.size(), expected.quadrics);
  EXPECT_EQ(scene.geometry->objects.size(), expected.objects);
  EXPECT_EQ(scene.geometry->triangles.size(), expected.triangles);
  EXPECT_EQ(scene.lights.size(), expected.lights);
  EXPECT_EQ(scene.materials.size(), expected.materials);
  EXPECT_TRUE(scene.notes.empty());
  EXPECT_EQ(scene.lights[0].color, glm::vec3(1 / std::sqrt(static_cast<float>(expected.lights))));
}

INSTANTIATE_TEST_SUITE_P(
    ThirdParty, NffData,
    testing::Values(Counts{"spd/balls-s4.nff", 7381, 7382, 2, 3, 2}, Counts{"spd/gears-s4.nff", 0, 9345, 36610, 5, 63},
                    Counts{"spd/mount-s6.nff", 4, 8196, 8192, 1, 2}, Counts{"spd/rings-s7.nff", 8400, 8401, 2, 3, 7},
                    Counts{"spd/teapot-s12.nff", 0, 9264, 9408, 2, 3}, Counts{"spd/tetra-s6.nff", 0, 4096, 4096, 1, 1},
                    Counts{"spd/tree-s11.nff", 8190, 8191, 2, 7, 2}, Counts{"spd/lattice-s12.nff", 8281, 8281, 0, 6, 4},
                    Counts{"spd/jacks-s3.nff", 657, 657, 0, 1, 1}, Counts{"spd/shells-s5.nff", 5761, 5761, 0, 1, 1},
                    Counts{"spd/sombrero-s3.nff", 0, 32258, 32258, 1, 1},
                    Counts{"spd/nurbtst-default.nff", 0, 1500, 1500, 1, 1},
                    Counts{"spd/tree-s15.nff", 131070, 131071, 2, 7, 2},
                    Counts{"spd/rings-s20.nff", 172200, 172201, 2, 3, 7},
                    Counts{"mol/1hpv.bs.nff", 4789, 4789, 0, 2, 4}, Counts{"mol/1tii.bs.nff", 16834, 16834, 0, 2, 4}));

}  // namespace
}  // namespace rayengine
