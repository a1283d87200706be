#include "engine/load/load.h"

#include <unistd.h>

#include "tests/load/loading.h"

namespace rayengine {
namespace {

namespace fs = std::filesystem;

constexpr const char* a_triangle = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

class LoadScene : public testing::Test {
 protected:
  std::string error(const fs::path& file) {
    return test::error_of([&] { load_scene(file); });
  }
  test::TemporaryFolder folder_;
};

TEST_F(LoadScene, GoesByTheExtensionInAnyCase) {
  EXPECT_EQ(load_scene(folder_.write("a.JSON", R"({"objects": [{"type": "sphere"}]})")).geometry->quadrics.size(), 1u);
  EXPECT_EQ(load_scene(folder_.write("a.Nff", "s 0 0 0 1")).geometry->quadrics.size(), 1u);
  EXPECT_EQ(load_scene(folder_.write("a.OFF", a_triangle)).geometry->triangles.size(), 1u);
  const std::string gltf = error(folder_.write("a.GLTF", "{}")), glb = error(folder_.write("a.glb", "{}"));
  EXPECT_NE(gltf.find("a.GLTF"), std::string::npos);
  EXPECT_NE(glb.find("a.glb"), std::string::npos);
  EXPECT_EQ(gltf.find("is no kind of scene"), std::string::npos);
}

TEST_F(LoadScene, AMeshGetsACameraThatFramesItAndAHeadlight) {
  const Scene scene = load_scene(folder_.write("a.off", a_triangle));
  EXPECT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.camera.at, glm::dvec3(0.5, 0.5, 0));
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].position, scene.camera.from);
  int cameras = 0, lights = 0;
  for (const std::string& note : scene.notes) {
    cameras += note.find("no camera") != std::string::npos;
    lights += note.find("no light") != std::string::npos;
  }
  EXPECT_EQ(cameras, 1);
  EXPECT_EQ(lights, 1);
}

TEST_F(LoadScene, WhatIsNoSceneIsRefused) {
  for (const char* name : {"scene.txt", "scene", ".json", "scene.json.gz"})
    EXPECT_NE(error(folder_.write(name, "s 0 0 0 1")).find("is no kind of scene that can be read; use .json, .nff"),
              std::string::npos)
        << name;
}

TEST_F(LoadScene, WhatCannotBeReadIsRefused) {
  for (const char* extension : {".json", ".nff", ".gltf", ".glb", ".obj", ".ply", ".stl", ".off"}) {
    const fs::path missing = folder_.path() / ("missing" + std::string(extension)),
                   folder = folder_.path() / ("folder" + std::string(extension));
    fs::create_directory(folder);
    EXPECT_EQ(error(missing), missing.string() + ": there is no such file; check its name");
    EXPECT_EQ(error(folder), folder.string() + ": is not a file; name a file to read");
    if (geteuid() == 0) continue;  // root may read everything
    const fs::path locked = folder_.write("locked" + std::string(extension), "");
    fs::permissions(locked, fs::perms::none);
    EXPECT_NE(error(locked).find("cannot be read"), std::string::npos);
  }
}

TEST_F(LoadScene, EmptyScenesAreRefused) {
  EXPECT_NE(error(folder_.write("a.nff", "v from 0 0 1 at 0 0 0 up 0 1 0"))
                .find("a.nff: there is nothing to see; a scene needs an object"),
            std::string::npos);
  for (const char* name : {"a.json", "a.off", "a.ply", "a.obj", "a.stl", "a.gltf", "a.glb"})
    EXPECT_NE(error(folder_.write(name, "")), "") << name;
}

TEST_F(LoadScene, WhatReachesBeyondSinglePrecisionIsRefused) {
  const std::string far_off = R"({"objects": [{"type": "plane"}, {"type": "triangles", "indices": [[0, 1, 2]],
    "vertices": [[0, 0, 0], [1e300, 0, 0], [0, 1, 0]]}]})";
  EXPECT_NE(error(folder_.write("a.json", far_off)).find("reaches farther than 1e18"), std::string::npos);
  EXPECT_NE(error(folder_.write("a.nff", "s 1e19 0 0 1")).find("a.nff: reaches farther than 1e18; scale it down"),
            std::string::npos);
}

}  // namespace
}  // namespace rayengine
