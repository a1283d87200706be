// The scenes of the repository: what the README says of them, and that they are what their generators write.
#include <set>

#include "engine/load/load.h"
#include "engine/load/text.h"
#include "tests/load/loading.h"

namespace rayengine {
namespace {

const std::filesystem::path scenes = std::filesystem::path(SOURCE_DIR) / "scenes";

TEST(Scenes, ASphereflakeOfDepthFour) {
  const Scene scene = load_json(scenes / "sphereflake.json");
  EXPECT_EQ(scene.geometry->primitive_count, 7381u + 1);
  EXPECT_EQ(scene.lights.size(), 3u);
  EXPECT_TRUE(scene.notes.empty());
}

TEST(Scenes, AGalleryOfEveryTypeCappedAndNot) {
  const Scene scene = load_json(scenes / "gallery.json");
  std::set<QuadricType> open, capped;
  for (const Quadric& q : scene.geometry->quadrics) (q.capped ? capped : open).insert(q.type);
  EXPECT_EQ(open.size(), quadric_type_count);
  EXPECT_EQ(capped.size(), 5u);
  EXPECT_TRUE(scene.notes.empty());
}

TEST(Scenes, ACornellBoxOf36Triangles) {
  const Scene scene = load_json(scenes / "cornell.json");
  EXPECT_EQ(scene.geometry->triangles.size(), 36u);
  EXPECT_TRUE(scene.notes.empty());
}

TEST(Scenes, AKnotOf1024TrianglesInTheBox) {
  const Scene scene = load_json(scenes / "knot.json");
  EXPECT_EQ(scene.geometry->triangles.size(), 12u + 1024u);
  EXPECT_FALSE(scene.geometry->normals.empty());
  EXPECT_TRUE(scene.notes.empty());
}

TEST(Scenes, GlassBendsLight) {
  const Scene scene = load_json(scenes / "glass.json");
  std::set<float> indices;
  for (const Material& material : scene.materials)
    if (material.transmit > 0) indices.insert(material.ior);
  EXPECT_EQ(indices, (std::set<float>{1.33f, 1.5f, 1.55f}));
  EXPECT_TRUE(scene.notes.empty());
}

class Generators : public test::LoaderTest {
 protected:
  Generators() : LoaderTest(load_json, "scene.json") {}

  /// What a generator writes; skips the test where there is no Python.
  std::string output(const std::string& generator, const std::string& arguments = "") {
    const std::filesystem::path file = folder_.path() / "output";
    const std::string command =
        "python3 '" + (scenes / generator).string() + "' " + arguments + " > '" + file.string() + "'";
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    return read_file(file);
  }

  void SetUp() override {
    if (std::system("python3 -c '' 2>/dev/null") != 0) GTEST_SKIP() << "no python3";
  }
};

TEST_F(Generators, WroteTheScenes) {
  EXPECT_EQ(output("make_sphereflake.py"), read_file(scenes / "sphereflake.json"));
  EXPECT_EQ(output("make_knot.py"), read_file(scenes / "knot.ply"));
}

TEST_F(Generators, MakeSphereflakesOfAnyDepth) {
  std::uint32_t spheres = 1;
  for (int depth = 0; depth < 7; ++depth, spheres = 9 * spheres + 1)
    EXPECT_EQ(load(output("make_sphereflake.py", std::to_string(depth))).geometry->primitive_count, spheres + 1)
        << depth;
}

}  // namespace
}  // namespace rayengine
