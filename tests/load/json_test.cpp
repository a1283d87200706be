#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/load/load.h"
#include "tests/load/loading.h"

namespace rayengine {
namespace {

class Json : public test::LoaderTest {
 protected:
  Json() : LoaderTest(load_json, "scene.json") {}

  /// A scene of one object, or of several with commas between them.
  Scene objects(const std::string& text) { return load("{\"objects\": [" + text + "]}"); }
  /// The error of a scene with one object, which starts in line 2.
  std::string object_error(const std::string& object) { return error("{\"objects\": [\n" + object + "]}"); }
};

TEST_F(Json, OnlyObjectsAreNeeded) {
  const Scene scene = load(R"({"objects": [{"type": "sphere"}]})");
  EXPECT_EQ(scene.geometry->quadrics.size(), 1u);
  EXPECT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.background.color, glm::vec3(0));
  EXPECT_EQ(scene.notes.size(), 2u);
}

TEST_F(Json, CameraBackgroundLightsAndMaterials) {
  const Scene scene = load(R"({
    "camera": {"from": [1, 2, 3], "at": [4, 5, 6], "up": [0, 1, 0], "fov": 30, "size": [640, 480]},
    "background": [0.1, 0.2, 0.4],
    "lights": [{"type": "point", "position": [4, -4, 8], "color": [1, 0.5, 0]},
               {"type": "directional", "direction": [0, 1, -1]}],
    "materials": {"glass": {"color": [1, 0, 0], "ambient": 0.5, "diffuse": 0.1, "specular": 0.25, "shininess": 60,
                            "reflect": 0.125, "transmit": 0.9, "ior": 1.5},
                  "plain": {}},
    "objects": [{"type": "sphere", "material": "plain"}, {"type": "disk", "material": "glass"}, {"type": "plane"}]})");
  EXPECT_EQ(scene.camera.from, glm::dvec3(1, 2, 3));
  EXPECT_EQ(scene.camera.at, glm::dvec3(4, 5, 6));
  EXPECT_EQ(scene.camera.up, glm::dvec3(0, 1, 0));
  EXPECT_EQ(scene.camera.fov, 30);
  EXPECT_EQ(scene.camera.size, glm::ivec2(640, 480));
  EXPECT_EQ(scene.background.color, glm::vec3(0.1f, 0.2f, 0.4f));
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.lights[0].position, glm::dvec3(4, -4, 8));
  EXPECT_EQ(scene.lights[0].color, glm::vec3(1, 0.5, 0));
  EXPECT_EQ(scene.lights[1].type, Light::Type::directional);
  EXPECT_EQ(scene.lights[1].direction, glm::dvec3(0, 1, -1));
  EXPECT_EQ(scene.lights[1].color, glm::vec3(1));
  ASSERT_EQ(scene.materials.size(), 3u);
  const Material& glass = scene.materials[1];
  EXPECT_EQ(glass.color, glm::vec3(1, 0, 0));
  EXPECT_EQ(glass.ambient, 0.5f);
  EXPECT_EQ(glass.diffuse, 0.1f);
  EXPECT_EQ(glass.specular, 0.25f);
  EXPECT_EQ(glass.shininess, 60);
  EXPECT_EQ(glass.reflect, 0.125f);
  EXPECT_EQ(glass.transmit, 0.9f);
  EXPECT_EQ(glass.ior, 1.5f);
  EXPECT_EQ(scene.geometry->objects[0].material, 2u);
  EXPECT_EQ(scene.geometry->objects[1].material, 1u);
  EXPECT_EQ(scene.geometry->objects[2].material, 0u);
  EXPECT_TRUE(scene.notes.empty());
}

TEST_F(Json, ACameraThatStandsNowhereFramesTheScene) {
  const Scene scene = load(R"({"camera": {"size": [64, 32], "fov": 20},
    "objects": [{"type": "sphere", "transform": [{"translate": [10, 0, 0]}]}, {"type": "plane"}]})");
  EXPECT_EQ(scene.camera.at, glm::dvec3(10, 0, 0));
  EXPECT_EQ(scene.camera.size, glm::ivec2(64, 32));
  EXPECT_EQ(scene.camera.fov, 20);
  // The bounding sphere of the unit sphere's box just fits the angle.
  const double distance = glm::length(scene.camera.from - scene.camera.at);
  EXPECT_NEAR(distance * std::sin(10 * M_PI / 180), std::sqrt(3), 0.1);
}

TEST_F(Json, EveryTypeOfQuadric) {
  const Scene scene = objects(R"(
    {"type": "sphere"}, {"type": "cylinder", "capped": true}, {"type": "cone", "capped": true, "clip": [0.25, 1]},
    {"type": "paraboloid"}, {"type": "hyperboloid1"}, {"type": "hyperboloid2"}, {"type": "saddle"}, {"type": "plane"},
    {"type": "disk"}, {"type": "quadric", "Q": [1,0,0,0, 1,0,0, -1,0, -0.25], "box": [[-1,-1,-1],[1,2,3]]})");
  const Geometry& geometry = *scene.geometry;
  ASSERT_EQ(geometry.quadrics.size(), quadric_type_count);
  for (std::size_t i = 0; i < quadric_type_count; ++i)
    EXPECT_EQ(static_cast<std::size_t>(geometry.quadrics[i].type), i);
  EXPECT_EQ(geometry.quadrics[2].zmin, 0.25);
  EXPECT_EQ(geometry.quadrics[5].zmax, 2);
  EXPECT_EQ(geometry.forms[0].box.upper, glm::dvec3(1, 2, 3));
  EXPECT_EQ(geometry.primitive_count, 10u + 2 * 2);
}

TEST_F(Json, StepsOfATransformAreAppliedFirstToLast) {
  const Scene scene = objects(R"({"type": "sphere", "transform": [{"scale": [1, 2, 3]},
    {"rotate": {"axis": [0, 0, 2], "degrees": 90}}, {"translate": [10, 0, 0]}, {"scale": 2}]})");
  const Affine map = object_to_world(scene.geometry->quadrics[0].to_object);
  EXPECT_LT(glm::length(map.point({1, 1, 1}) - glm::dvec3(2 * (10 - 2), 2 * 1, 2 * 3)), 1e-12);
}

TEST_F(Json, AMatrixIsReadRowByRow) {
  const Scene scene = objects(R"({"type": "sphere", "transform": [1,2,0,10, 0,1,0,20, 0,0,1,30, 0,0,0,1]})");
  const Affine map = object_to_world(scene.geometry->quadrics[0].to_object);
  EXPECT_LT(glm::length(map.point({1, 1, 1}) - glm::dvec3(13, 21, 31)), 1e-12);
}

TEST_F(Json, InlineTriangles) {
  const Scene scene = objects(R"({"type": "triangles", "vertices": [[0,0,0],[1,0,0],[0,1,0],[0.1,0,1]],
    "indices": [[0,1,2],[0,1,3]], "transform": [{"translate": [0, 0, 5]}]}, {"type": "sphere"})");
  EXPECT_EQ(scene.geometry->triangles.size(), 2u);
  EXPECT_EQ(scene.geometry->vertex(3), glm::dvec3(0.1, 0, 6));
  EXPECT_EQ(scene.geometry->objects[1].first_primitive, 2u);
}

TEST_F(Json, MeshFilesStandBesideTheScene) {
  folder_.write("one.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const Scene scene = objects(R"({"type": "mesh", "file": "one.off"})");
  EXPECT_EQ(scene.geometry->triangles.size(), 1u);
  const std::string message = object_error(R"({"type": "mesh",
    "file": "none.off"})");
  EXPECT_NE(message.find("none.off"), std::string::npos);
  EXPECT_NE(message.find("scene.json:3"), std::string::npos) << message;
}

TEST_F(Json, GroupsMayBePlacedWithinGroups) {
  const Scene scene = load(R"({
    "groups": {"pair": {"objects": [{"type": "instance", "group": "ball", "transform": [{"translate": [1, 0, 0]}]},
                                    {"type": "instance", "group": "ball", "transform": [{"translate": [-1, 0, 0]}]}]},
               "ball": {"objects": [{"type": "sphere", "transform": [{"scale": 0.5}]}]}},
    "objects": [{"type": "instance", "group": "pair"},
                {"type": "instance", "group": "pair", "transform": [{"scale": 2}, {"translate": [0, 0, 5]}]},
                {"type": "instance", "group": "ball"}]})");
  const Geometry& geometry = *scene.geometry;
  EXPECT_EQ(geometry.objects.size(), 3u);
  EXPECT_EQ(geometry.primitive_count, 5u);
  EXPECT_EQ(geometry.bounds.lower, glm::dvec3(-3, -1, -0.5));
  EXPECT_EQ(geometry.bounds.upper, glm::dvec3(3, 1, 6));
}

TEST_F(Json, SyntaxErrorsNameTheirLine) {
  EXPECT_EQ(error(""),
            "scene.json:1: not valid JSON: syntax error while parsing value - unexpected end of input; expected '[', "
            "'{', or a literal");
  EXPECT_EQ(error("{\n\"objects\": [\n1 2]}").find("scene.json:3: not valid JSON: syntax error"), 0u);
  EXPECT_EQ(error("{\n\"objects\": [1\n,\n]}").find("scene.json:4: not valid JSON: syntax error"), 0u);
  EXPECT_EQ(error("{\"objects\n").find("scene.json:1: not valid JSON: syntax error"), 0u);
  EXPECT_EQ(error("{}\n\n x").find("scene.json:3: not valid JSON: syntax error"), 0u);
  EXPECT_EQ(error("{\"fov\": NaN}").find("scene.json:1: not valid JSON: syntax error"), 0u);
  EXPECT_EQ(error("{\"fov\":\n 1e999\n}"), "scene.json:2: not valid JSON: number overflow parsing '1e999'");
  EXPECT_EQ(error("{\"a\": \"\xff\"}").find("scene.json:1: not valid JSON: syntax error"), 0u);
  EXPECT_EQ(error(std::string(100, '[')), "scene.json:1: nested more than 64 deep");
  EXPECT_EQ(error(std::string(1000000, '[')), "scene.json:1: nested more than 64 deep");
  EXPECT_EQ(error("{\"a\": 1,\n\"b\": 2,\n\"a\": 3}"), "scene.json:3: the key 'a' comes twice; keep one");
  const std::string long_line = error("{\"" + std::string(100000, 'x'));
  EXPECT_LT(long_line.size(), 400u);
}

TEST_F(Json, LinesOfNumbersAreTheirOwn) {
  EXPECT_EQ(error("{\"objects\":\n1\n}"), "scene.json:2: expected a list for 'objects', got a number");
  EXPECT_EQ(error("{\"objects\":\n12.5\n\n}"), "scene.json:2: expected a list for 'objects', got a number");
  EXPECT_EQ(error("\n\n1\n"), "scene.json:3: expected an object for 'scene', got a number");
  EXPECT_EQ(error("1"), "scene.json:1: expected an object for 'scene', got a number");
}

TEST_F(Json, UnknownKeysNameTheirLine) {
  EXPECT_EQ(
      error("{\"objects\": [],\n\"Lights\": []}"),
      "scene.json:2: unknown key 'Lights' in 'scene'; use camera, background, lights, materials, groups, objects");
  EXPECT_EQ(error("{\"camera\": {\n\"zoom\": 1}}"),
            "scene.json:2: unknown key 'zoom' in 'camera'; use from, at, up, fov, size");
  EXPECT_EQ(error("{\"materials\": {\"red\": {\n\"colour\": 1}}}"),
            "scene.json:2: unknown key 'colour' in 'red'; use color, ambient, diffuse, specular, shininess, reflect, "
            "transmit, ior");
  EXPECT_EQ(error("{\"lights\": [{\"position\": [0,0,0],\n\"direction\": [0,0,1]}]}"),
            "scene.json:2: unknown key 'direction' in 'lights'; use type, position, color");
  EXPECT_EQ(object_error("{\"type\": \"sphere\", \"radius\": 2}"),
            "scene.json:2: unknown key 'radius' in 'objects'; use type, capped, clip, box, material, transform");
  EXPECT_EQ(object_error("{\"type\": \"disk\", \"clip\": [0, 1]}"),
            "scene.json:2: unknown key 'clip' in 'objects'; use type, capped, material, transform");
  EXPECT_EQ(object_error("{\"type\": \"sphere\", \"transform\": [{\"turn\": 1}]}"),
            "scene.json:2: unknown key 'turn' in 'transform'; use scale, rotate, translate");
  EXPECT_EQ(
      object_error("{\"type\": \"sphere\", \"a\\nb\\u0000\\u001b\": 1}").find("scene.json:2: unknown key 'a?b?\?' in"),
      0u);
}

TEST_F(Json, MistypedValuesNameTheirLine) {
  EXPECT_EQ(error("{\"camera\": {\"fov\":\n\"wide\"}}"), "scene.json:2: expected a number for 'fov', got a string");
  EXPECT_EQ(error("{\"camera\": {\"from\": [1, 2]}}"), "scene.json:1: expected 3 numbers for 'from', got 2");
  EXPECT_EQ(error("{\"camera\": {\"from\": [1, 2,\nnull]}}"), "scene.json:2: expected a number for 'from', got null");
  EXPECT_EQ(error("{\"camera\": []}"), "scene.json:1: expected an object for 'camera', got a list");
  EXPECT_EQ(error("{\"lights\": {}}"), "scene.json:1: expected a list for 'lights', got an object");
  EXPECT_EQ(error("{\"lights\": [{\"type\": \"spot\"}]}"),
            "scene.json:1: unknown type of light 'spot'; use point or directional");
  EXPECT_EQ(object_error("{\"type\": 3}"), "scene.json:2: expected a string for 'type', got a number");
  EXPECT_EQ(object_error("{\"type\": \"torus\"}"),
            "scene.json:2: unknown type of object 'torus'; use sphere, cylinder, cone, paraboloid, hyperboloid1, "
            "hyperboloid2, "
            "saddle, plane, disk, quadric, mesh, triangles or instance");
  EXPECT_EQ(object_error("{}"), "scene.json:2: 'objects' lacks 'type'; give it one");
  EXPECT_EQ(object_error("{\"type\": \"cone\", \"capped\": 1}"),
            "scene.json:2: expected true or false for 'capped', got a number");
  EXPECT_EQ(object_error("{\"type\": \"mesh\"}"), "scene.json:2: 'objects' lacks 'file'; give it one");
  EXPECT_EQ(object_error("{\"type\": \"triangles\", \"vertices\": [[0,0,0]], \"indices\": [[0,0,\n1]]}"),
            "scene.json:3: expected a whole number from 0 to 0 for 'indices'");
  EXPECT_EQ(object_error("{\"type\": \"triangles\", \"vertices\": [[0,0,0]], \"indices\": [[0,0,0.5]]}"),
            "scene.json:2: expected a whole number from 0 to 0 for 'indices'");
  EXPECT_EQ(object_error("{\"type\": \"triangles\", \"vertices\": [], \"indices\": []}"),
            "scene.json:2: there is no triangle in 'indices'; give it one");
  EXPECT_EQ(object_error("{\"type\": \"sphere\", \"transform\": [1, 2]}"),
            "scene.json:2: expected 16 numbers for 'transform', got 2");
}

TEST_F(Json, ValuesOutOfRangeNameTheirLine) {
  EXPECT_EQ(error("{\"camera\": {\"size\": [0, 0]}}"),
            "scene.json:1: expected a whole number from 1 to 65536 for 'size'");
  EXPECT_EQ(error("{\"camera\": {\"size\": [100000, 100000]}}"),
            "scene.json:1: expected a whole number from 1 to 65536 for 'size'");
  EXPECT_EQ(error("{\"camera\": {\"size\": [1.5, 2]}}"),
            "scene.json:1: expected a whole number from 1 to 65536 for 'size'");
  EXPECT_EQ(error("{\n\"camera\": {\"fov\": 180}}"),
            "scene.json:2: the camera's angle is out of range; it must lie between 0 and 180 degrees");
  EXPECT_EQ(error("{\n\"camera\": {\"from\": [0,0,0]}}"),
            "scene.json:2: the camera stands where it looks; 'from' and 'at' must differ");
  EXPECT_EQ(error("{\n\"camera\": {\"from\": [0,0,5]}}"),
            "scene.json:2: the camera's up is zero or along its view; turn it away");
  EXPECT_EQ(error("{\"background\": [1, -1, 1]}"), "scene.json:1: 'background' is negative or too large");
  EXPECT_EQ(error("{\"background\": [1, 1e39, 1]}"), "scene.json:1: 'background' is negative or too large");
  EXPECT_EQ(error("{\"materials\": {\"a\": {\"ior\": 0}}}"),
            "scene.json:1: an index of refraction is zero; that of glass is 1.5");
  EXPECT_EQ(error("{\"lights\": [{\"type\": \"directional\", \"direction\": [0,0,0]}]}"),
            "scene.json:1: a light's direction is zero; give it one");
  EXPECT_EQ(object_error("{\"type\": \"sphere\", \"transform\": [{\"scale\": 0}]}"),
            "scene.json:2: a transform is singular or not finite: it must map space one to one");
  EXPECT_EQ(object_error("{\"type\": \"sphere\", \"transform\": [{\"scale\": 1e200}, {\"scale\": 1e200}]}"),
            "scene.json:2: a transform is singular or not finite: it must map space one to one");
  EXPECT_EQ(object_error("{\"type\": \"sphere\", \"transform\": [{\"rotate\": {\"axis\": [0,0,0], \"degrees\": 1}}]}"),
            "scene.json:2: a rotation's axis is zero: give it a direction");
  EXPECT_EQ(object_error("{\"type\": \"sphere\", \"transform\": [{\"scale\": 2, \"translate\": [1,1,1]}]}"),
            "scene.json:2: a step of a transform is not one of scale, rotate and translate; give each its own braces");
  EXPECT_EQ(object_error("{\"type\": \"sphere\", \"transform\": [1,0,0,0,0,1,0,0,0,0,1,0,1,0,0,1]}"),
            "scene.json:2: the last row of a transform is not 0, 0, 0, 1; only affine maps are taken, row by row");
  EXPECT_EQ(object_error("{\"type\": \"cone\", \"clip\": [1, 0]}"),
            "scene.json:2: the clip of a cone is empty: its first number must be the smaller");
  EXPECT_EQ(object_error("{\"type\": \"sphere\", \"capped\": true}"), "scene.json:2: a sphere cannot be capped");
  EXPECT_EQ(object_error("{\"type\": \"quadric\"}"), "scene.json:2: a quadric needs the ten numbers of its matrix");
}

TEST_F(Json, WhatDoesNotExistNamesItsLine) {
  EXPECT_EQ(error("{}"), "scene.json:1: 'scene' lacks 'objects'; give it one");
  EXPECT_EQ(error("{\n\"objects\": []}"), "scene.json:2: there is nothing in 'objects'; give it an object");
  EXPECT_EQ(object_error("{\"type\": \"sphere\", \"material\": \"gold\"}"),
            "scene.json:2: there is no material 'gold'");
  EXPECT_EQ(object_error("{\"type\": \"instance\", \"group\": \"tree\"}"), "scene.json:2: there is no group 'tree'");
  const std::string message = error("{\"background\": {\n\"image\": \"none.exr\"}}");
  EXPECT_NE(message.find("scene.json:2: "), std::string::npos) << message;
}

TEST_F(Json, GroupsThatHoldThemselvesAreRefused) {
  EXPECT_EQ(error(R"({"objects": [{"type": "instance", "group": "a"}], "groups": {
    "a": {"objects": [{"type": "instance", "group": "b"}]},
    "b": {"objects": [{"type": "instance", "group": "a"}]}}})"),
            "scene.json:3: group 'a' holds itself");
  EXPECT_EQ(error(R"({"objects": [{"type": "sphere"}], "groups": {
    "unused": {"objects": [{"type": "instance", "group": "unused"}]}}})"),
            "scene.json:2: group 'unused' holds itself");
}

TEST_F(Json, GroupsThatNestTooDeepAreRefused) {
  std::string text = "{\"objects\": [{\"type\": \"instance\", \"group\": \"g0\"}], \"groups\": {";
  for (int i = 0; i < 70; ++i)
    text += "\"g" + std::to_string(i) + "\": {\"objects\": [{\"type\": \"instance\", \"group\": \"g" +
            std::to_string(i + 1) + "\"}]},\n";
  EXPECT_EQ(error(text + "\"g70\": {\"objects\": [{\"type\": \"sphere\"}]}}}"),
            "scene.json:64: groups hold each other more than 64 deep");
}

TEST_F(Json, GroupsThatMultiplyBeyondMemoryAreRefused) {
  std::string text = R"({"objects": [{"type": "instance", "group": "g0"}], "groups": {)";
  for (int i = 0; i < 20; ++i) {
    const std::string next = R"({"type": "instance", "group": "g)" + std::to_string(i + 1) + "\"}";
    text += "\n\"g" + std::to_string(i) + "\": {\"objects\": [" + next;
    for (int k = 1; k < 64; ++k) text += ", " + next;
    text += "]},";
  }
  EXPECT_EQ(error(text + "\n\"g20\": {\"objects\": [{\"type\": \"sphere\"}]}}}")
                .find("scene.json:18: groups multiply to more than"),
            0u);
}

}  // namespace
}  // namespace rayengine
