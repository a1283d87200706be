#include <gtest/gtest.h>

#include <cstring>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <random>

#include "accel/tracer.h"
#include "engine/load/load.h"
#include "tests/load/expect_error.h"
#include "tests/temporary.h"

namespace rayengine {
namespace {

using Json = nlohmann::json;
using test::expect_error;

constexpr int u8 = 5121, u16 = 5123, u32 = 5125, f32 = 5126, i16 = 5122;

std::string base64(const std::string& bytes) {
  constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// Puts a glTF file together.
struct Builder {
  Json json = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", Json::array()}}}}};
  std::string bytes;

  template <class T>
  int view(const std::vector<T>& values) {
    while (bytes.size() % 4) bytes += '\0';
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(T)}});
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    return int(json["bufferViews"].size()) - 1;
  }

  int accessor(int buffer_view, int component, const char* type, std::size_t count) {
    json["accessors"].push_back(
        {{"bufferView", buffer_view}, {"componentType", component}, {"type", type}, {"count", count}});
    if (buffer_view < 0) json["accessors"].back().erase("bufferView");
    return int(json["accessors"].size()) - 1;
  }

  int positions(const std::vector<float>& xyz) { return accessor(view(xyz), f32, "VEC3", xyz.size() / 3); }

  int mesh(const Json& primitive) {
    json["meshes"].push_back({{"primitives", {primitive}}});
    return int(json["meshes"].size()) - 1;
  }

  int node(const Json& node, bool is_root = true) {
    json["nodes"].push_back(node);
    const int index = int(json["nodes"].size()) - 1;
    if (is_root) json["scenes"][0]["nodes"].push_back(index);
    return index;
  }

  Json complete(const Json& uri) const {
    Json file = json;
    file["buffers"] = {{{"byteLength", bytes.size()}}};
    if (!uri.is_null()) file["buffers"][0]["uri"] = uri;
    return file;
  }

  std::string gltf() const { return complete("data:application/octet-stream;base64," + base64(bytes)).dump(); }

  std::string glb() const {
    std::string text = complete(nullptr).dump(), data = bytes;
    while (text.size() % 4) text += ' ';
    while (data.size() % 4) data += '\0';
    std::string file = "glTF";
    const auto put = [&](std::size_t value) {
      const auto word = static_cast<std::uint32_t>(value);
      file.append(reinterpret_cast<const char*>(&word), sizeof word);
    };
    put(2), put(12 + 8 + text.size() + 8 + data.size());
    put(text.size()), file += "JSON" + text;
    put(data.size()), file += std::string("BIN\0", 4) + data;
    return file;
  }
};

const std::vector<float> square = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

/// One square of two triangles, with a plain node.
Builder square_scene() {
  Builder b;
  const int position = b.positions(square);
  const int indices = b.accessor(b.view(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}), u16, "SCALAR", 6);
  b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", position}}}, {"indices", indices}})}});
  return b;
}

class Gltf : public testing::Test {
 protected:
  Scene load(const Builder& builder) { return load_gltf(folder.write("a.gltf", builder.gltf())); }
  void fails(const Builder& builder, const std::string& what) {
    expect_error([&] { load(builder); }, "a.gltf", what);
  }
  static bool notes_say(const Scene& scene, const std::string& part) {
    return std::ranges::any_of(scene.notes, [&](const std::string& n) { return n.find(part) != n.npos; });
  }

  test::TemporaryFolder folder;
};

TEST_F(Gltf, ReadsEveryKindOfFile) {
  const Builder b = square_scene();
  folder.write("data.bin", b.bytes);
  for (const auto& file : {folder.write("a.gltf", b.gltf()), folder.write("b.glb", b.glb()),
                           folder.write("c.gltf", b.complete("data.bin").dump())}) {
    const Scene scene = load_gltf(file);
    ASSERT_EQ(scene.geometry->objects.size(), 1u) << file;
    EXPECT_EQ(scene.geometry->vertices.size(), 4u);
    EXPECT_EQ(scene.geometry->triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_TRUE(notes_say(scene, "no camera")) << file;
    EXPECT_TRUE(notes_say(scene, "no light"));
    EXPECT_EQ(scene.camera.up, glm::dvec3(0, 1, 0));
    EXPECT_GT(scene.camera.from.y, scene.camera.at.y);
    EXPECT_EQ(scene.lights.size(), 1u);
  }
}

TEST_F(Gltf, ReadsEveryModeOfTrianglesAndTypeOfIndices) {
  const std::vector<glm::uvec3> list = {{0, 1, 2}}, strip = {{0, 1, 2}, {1, 3, 2}}, fan = {{1, 2, 0}, {2, 3, 0}};
  for (const auto& [mode, expected] : {std::pair(5, strip), std::pair(6, fan)}) {
    Builder b;
    b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", b.positions(square)}}}, {"mode", mode}})}});
    EXPECT_EQ(load(b).geometry->triangles, expected);
  }
  for (const int type : {u8, u16, u32}) {
    Builder b;
    const int position = b.positions(square);
    const int view = type == u8    ? b.view(std::vector<std::uint8_t>{0, 1, 2})
                     : type == u16 ? b.view(std::vector<std::uint16_t>{0, 1, 2})
                                   : b.view(std::vector<std::uint32_t>{0, 1, 2});
    b.node({{"mesh",
             b.mesh({{"attributes", {{"POSITION", position}}}, {"indices", b.accessor(view, type, "SCALAR", 3)}})}});
    EXPECT_EQ(load(b).geometry->triangles, list);
  }
}

TEST_F(Gltf, ReadsStridesNormalsAndQuantisedPositions) {
  Builder b;
  const std::vector<float> interleaved = {0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 0};
  const int view = b.view(interleaved);
  b.json["bufferViews"][0]["byteStride"] = 24;
  const int position = b.accessor(view, f32, "VEC3", 3), normal = b.accessor(view, f32, "VEC3", 3);
  b.json["accessors"][1]["byteOffset"] = 12;
  b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}})}});
  const Scene scene = load(b);
  EXPECT_EQ(scene.geometry->vertices, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(scene.geometry->normals, (std::vector<glm::vec3>{{0, 0, 1}, {0, 0, 1}, {0, 1, 0}}));

  Builder q;
  const int packed = q.view(std::vector<std::int16_t>{-32768, 0, 0, 0, 32767, 0, 0, 0, 0, 32767, 0, 0});
  q.json["bufferViews"][0]["byteStride"] = 8;
  q.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  const int quantised = q.accessor(packed, i16, "VEC3", 3);
  q.json["accessors"][0]["normalized"] = true;
  q.node({{"mesh", q.mesh({{"attributes", {{"POSITION", quantised}}}})}});
  EXPECT_EQ(load(q).geometry->vertices, (std::vector<glm::vec3>{{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST_F(Gltf, ReadsSparseAccessors) {
  Builder b;
  const int position = b.positions(square), zeros = b.accessor(-1, f32, "VEC3", 3);
  const Json where = {{"bufferView", b.view(std::vector<std::uint8_t>{1, 2})}, {"componentType", u8}};
  const Json what = {{"bufferView", b.view(std::vector<float>{7, 8, 9, 4, 5, 6})}};
  for (const int a : {position, zeros})
    b.json["accessors"][std::size_t(a)]["sparse"] = {{"count", 2}, {"indices", where}, {"values", what}};
  b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", zeros}}}})}});
  b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", position}}}, {"mode", 6}})}});
  const Scene scene = load(b);
  EXPECT_EQ(scene.geometry->vertices,
            (std::vector<glm::vec3>{{0, 0, 0}, {7, 8, 9}, {4, 5, 6}, {0, 0, 0}, {7, 8, 9}, {4, 5, 6}, {0, 1, 0}}));
  b.json["accessors"][0]["sparse"]["count"] = 3;
  fails(b, "reaches beyond its buffer");
  b.json["accessors"][0]["sparse"]["count"] = -1;
  fails(b, "a.gltf");
}

TEST_F(Gltf, PlacesNodesByMatricesAndByTurnsOfTheirParents) {
  Builder b = square_scene();
  const double half = std::sqrt(0.5);
  b.json["nodes"][0] = {{"children", {1}}, {"translation", {10, 0, 0}}, {"rotation", {0, 0, half, half}}};
  b.node({{"mesh", 0}, {"scale", {2, 3, 4}}, {"children", {2}}}, false);
  b.node({{"mesh", b.mesh(b.json["meshes"][0]["primitives"][0])},
          {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1}}},
         false);
  const Scene scene = load(b);
  ASSERT_EQ(scene.geometry->objects.size(), 2u);
  const glm::dvec3 expected[] = {{10, 0, 0},  {10, 2, 0},  {7, 2, 0},  {7, 0, 0},
                                 {10, 0, 20}, {10, 2, 20}, {7, 2, 20}, {7, 0, 20}};
  for (std::uint32_t i = 0; i < 8; ++i) EXPECT_LT(glm::distance(scene.geometry->vertex(i), expected[i]), 1e-14) << i;
}

TEST_F(Gltf, InstancesMeshesThatNodesShare) {
  Builder b = square_scene();
  b.node({{"mesh", 0}, {"translation", {5, 0, 0}}});
  b.node({{"mesh", 0}, {"scale", {0, 0, 0}}});
  const Scene scene = load(b);
  EXPECT_TRUE(scene.geometry->triangles.empty());
  ASSERT_EQ(scene.geometry->instances.size(), 2u);
  ASSERT_EQ(scene.geometry->groups.size(), 1u);
  EXPECT_EQ(scene.geometry->groups[0]->triangles.size(), 2u);
  EXPECT_EQ(scene.geometry->bounds.upper, glm::dvec3(6, 1, 0));
  EXPECT_TRUE(notes_say(scene, "1 nodes scaled to no volume"));
}

TEST_F(Gltf, ReadsMaterials) {
  Builder b = square_scene();
  b.json["materials"] = {
      {{"pbrMetallicRoughness",
        {{"baseColorFactor", {0.25, 0.5, 0.75, 1}}, {"metallicFactor", 0.5}, {"roughnessFactor", 0.5}}}},
      Json::object()};
  Json primitive = b.json["meshes"][0]["primitives"][0];
  for (const int material : {0, 1}) {
    primitive["material"] = material;
    b.json["meshes"][0]["primitives"].push_back(primitive);
  }
  const Scene scene = load(b);
  ASSERT_EQ(scene.geometry->objects.size(), 3u);
  const auto material = [&](std::size_t i) { return scene.materials.at(scene.geometry->objects[i].material); };
  EXPECT_EQ(material(0).color, glm::vec3(1));
  EXPECT_EQ(material(1).color, glm::vec3(0.25f, 0.5f, 0.75f));
  EXPECT_EQ(material(1).reflect, 0.25f);
  EXPECT_EQ(material(1).diffuse, 0.75f);
  EXPECT_EQ(material(2).color, glm::vec3(1));
  EXPECT_EQ(material(2).diffuse, 1);
}

TEST_F(Gltf, ReadsCameras) {
  Builder b = square_scene();
  b.json["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}, {"aspectRatio", 1.5}}}},
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 1}, {"zfar", 2}}}}};
  b.node({{"camera", 1}});
  b.node({{"camera", 0}, {"translation", {1, 2, 3}}, {"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}}});
  b.node({{"camera", 0}});
  const Scene scene = load(b);
  EXPECT_EQ(scene.camera.from, glm::dvec3(1, 2, 3));
  EXPECT_LT(glm::distance(scene.camera.at - scene.camera.from, glm::dvec3(-1, 0, 0)), 1e-15);
  EXPECT_LT(glm::distance(scene.camera.up, glm::dvec3(0, 1, 0)), 1e-15);
  EXPECT_DOUBLE_EQ(scene.camera.fov, 57.29577951308232);
  EXPECT_EQ(scene.camera.size, glm::ivec2(768, 512));
  EXPECT_TRUE(notes_say(scene, "without perspective"));
  EXPECT_TRUE(notes_say(scene, "the first is used"));
  EXPECT_FALSE(notes_say(scene, "no camera"));
}

TEST_F(Gltf, ReadsLightsAndBalancesThem) {
  Builder b = square_scene();  // its centre is (0.5, 0.5, 0)
  b.json["extensionsUsed"] = {"KHR_lights_punctual"};
  b.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"color", {1, 0.5, 0}}, {"intensity", 400}},
      {{"type", "directional"}, {"intensity", 2}},
      {{"type", "spot"}, {"intensity", 100}, {"spot", Json::object()}}};
  const auto light = [](int i) { return Json{{"KHR_lights_punctual", {{"light", i}}}}; };
  b.node({{"extensions", light(0)}, {"translation", {0.5, 10.5, 0}}});
  b.node({{"extensions", light(1)}, {"rotation", {std::sqrt(0.5), 0, 0, std::sqrt(0.5)}}});
  b.node({{"extensions", light(2)}, {"translation", {0.5, 0.5, 10}}});
  const Scene scene = load(b);
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[0].type, Light::Type::point);
  EXPECT_EQ(scene.lights[0].position, glm::dvec3(0.5, 10.5, 0));
  EXPECT_EQ(scene.lights[0].color, glm::vec3(1, 0.5f, 0));  // 400 / 10^2 = 4, the brightest
  EXPECT_EQ(scene.lights[1].type, Light::Type::directional);
  EXPECT_LT(glm::distance(scene.lights[1].direction, glm::dvec3(0, 1, 0)), 1e-15);
  EXPECT_EQ(scene.lights[1].color, glm::vec3(0.5f));
  EXPECT_EQ(scene.lights[2].type, Light::Type::point);
  EXPECT_EQ(scene.lights[2].color, glm::vec3(0.25f));
  EXPECT_TRUE(notes_say(scene, "spot lights"));
}

TEST_F(Gltf, PassesOverWhatIsNotUsed) {
  Builder b = square_scene();
  b.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 1}});
  b.json["images"] = {{{"uri", "none.png"}}};
  b.json["textures"] = {{{"source", 0}}};
  const Scene scene = load(b);
  EXPECT_EQ(scene.geometry->objects.size(), 1u);
  EXPECT_TRUE(notes_say(scene, "1 primitives without triangles"));
  EXPECT_TRUE(notes_say(scene, "textures are not used"));
}

TEST_F(Gltf, RejectsWhatIsOutOfRange) {
  const auto broken = [&](const char* pointer, const Json& value, const std::string& what) {
    Builder b = square_scene();
    b.json[Json::json_pointer(pointer)] = value;
    SCOPED_TRACE(pointer);
    fails(b, what);
  };
  broken("/scene", 3, "scene 3 does not exist");
  broken("/scenes/0/nodes/0", 9, "node 9 does not exist");
  broken("/nodes/0/children", {0}, "node 0 has two parents or is its own");
  broken("/nodes/0/mesh", 4, "mesh 4 does not exist");
  broken("/nodes/0/camera", 4, "camera 4 does not exist");
  broken("/meshes/0/primitives/0/material", 2, "material 2 does not exist");
  broken("/meshes/0/primitives/0/indices", 7, "accessor out of bounds");
  broken("/meshes/0/primitives/0/indices", 0, "accessor 0 does not hold indices");
  broken("/meshes/0/primitives/0/attributes/POSITION", 1, "accessor 1 does not hold vectors");
  broken("/accessors/0/count", 5, "accessor 0 reaches beyond its buffer");
  broken("/accessors/0/count", 4000000000u, "accessor 0 reaches beyond its buffer");
  broken("/accessors/0/count", 2, "a.gltf");
  broken("/accessors/0/byteOffset", 4, "accessor 0 reaches beyond its buffer");
  broken("/accessors/0/bufferView", 9, "a.gltf");
  broken("/accessors/1/count", 5, "three corners");
  broken("/bufferViews/0/byteLength", 4000000, "reaches beyond its buffer");
  broken("/bufferViews/0/byteOffset", 4000000, "reaches beyond its buffer");
  broken("/bufferViews/0/byteStride", 252, "reaches beyond its buffer");
  broken("/bufferViews/0/buffer", 3, "a.gltf");
  broken("/extensionsRequired", {"KHR_draco_mesh_compression"}, "needs the extension 'KHR_draco_mesh_comp");
}

TEST_F(Gltf, RejectsWhatIsNoGltf) {
  expect_error([&] { load_gltf(folder.path() / "none.gltf"); }, "none.gltf", "no such file");
  expect_error([&] { load_gltf(folder.path()); }, folder.path().string(), "is not a file");
  for (const char* content : {"", "{", "[]", "null", "glTF", "{\"asset\":{\"version\":\"2.0\"}} x", "\xff\xfe"})
    expect_error([&] { load_gltf(folder.write("a.gltf", content)); }, "a.gltf", "is not a sound glTF file");
  const std::string deep =
      "{\"asset\":{\"version\":\"2.0\"},\"extras\":" + std::string(100'000, '[') + std::string(100'000, ']') + "}";
  expect_error([&] { load_gltf(folder.write("a.gltf", deep)); }, "a.gltf", "nest more than");
  expect_error([&] { load_gltf(folder.write("a.gltf", square_scene().complete("none.bin").dump())); }, "a.gltf",
               "is not a sound");
  const std::string glb = square_scene().glb();
  for (std::size_t size = 0; size < glb.size(); size += 7)
    EXPECT_THROW(load_gltf(folder.write("a.glb", glb.substr(0, size))), Error) << size;
}

TEST_F(Gltf, NeverCrashesOnDamage) {
  std::mt19937 random(5);
  Builder b = square_scene();
  b.node({{"mesh", 0}, {"translation", {5, 0, 0}}});
  const std::string glb = b.glb();
  int loaded = 0, rejected = 0;
  for (int round = 0; round < 300; ++round) {
    std::string damaged = glb;
    for (int i = 0; i < 1 + round % 3; ++i)
      damaged[random() % damaged.size()] = static_cast<char>(round % 2 ? random() : '0' + random() % 10);
    try {
      load_gltf(folder.write("a.glb", damaged));
      ++loaded;
    } catch (const Error&) {
      ++rejected;
    }
  }
  EXPECT_GT(loaded, 10);
  EXPECT_GT(rejected, 50);
}

}  // namespace
}  // namespace rayengine
