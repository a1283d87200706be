#include "engine/load/mesh_cache.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <iterator>
#include <limits>

#include "accel/tracer.h"
#include "engine/measure/tessellate.h"
#include "tests/temporary.h"

namespace rayengine {
namespace {

namespace fs = std::filesystem;

/// With a cache folder of its own.
class MeshCache : public testing::Test {
 protected:
  MeshCache() { setenv("XDG_CACHE_HOME", cache_.path().c_str(), 1); }
  ~MeshCache() override { unsetenv("XDG_CACHE_HOME"); }

  fs::path folder() const { return cache_.path() / "rayengine"; }
  std::vector<fs::path> files() const {
    std::vector<fs::path> list;
    if (fs::exists(folder()))
      for (const auto& entry : fs::directory_iterator(folder())) list.push_back(entry.path());
    return list;
  }

  const test::TemporaryFolder cache_;
  const Mesh sphere_ = subdivided_sphere(3);
  static constexpr double tolerance = 0.1;
};

void expect_same(const CoarserMesh& a, const CoarserMesh& b) {
  EXPECT_EQ(a.mesh.positions, b.mesh.positions);
  EXPECT_EQ(a.mesh.normals, b.mesh.normals);
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
  EXPECT_EQ(a.distance, b.distance);
}

TEST_F(MeshCache, GivesTheSameTheSecondTime) {
  EXPECT_FALSE(find_simplified(sphere_, tolerance));
  const CoarserMesh first = simplify_cached(sphere_, tolerance);
  EXPECT_LT(first.mesh.triangles.size(), sphere_.triangles.size());
  ASSERT_EQ(files().size(), 1u);
  const auto found = find_simplified(sphere_, tolerance);
  ASSERT_TRUE(found);
  expect_same(*found, first);
  expect_same(simplify_cached(sphere_, tolerance), first);
  EXPECT_EQ(files().size(), 1u);
}

TEST_F(MeshCache, KeepsNormals) {
  Mesh mesh = sphere_;
  for (const glm::dvec3& p : mesh.positions) mesh.normals.push_back(glm::vec3(p));
  const CoarserMesh first = simplify_cached(mesh, tolerance);
  EXPECT_FALSE(first.mesh.normals.empty());
  expect_same(find_simplified(mesh, tolerance).value(), first);
  EXPECT_FALSE(find_simplified(sphere_, tolerance));
}

TEST_F(MeshCache, RemembersThatThereIsNothingToDrop) {
  const CoarserMesh same = simplify_cached(sphere_, 1e-9);
  EXPECT_EQ(same.distance, 0);
  EXPECT_LT(fs::file_size(files().at(0)), 200u);
  expect_same(find_simplified(sphere_, 1e-9).value(), same);
}

TEST_F(MeshCache, TellsMeshesAndTolerancesApart) {
  simplify_cached(sphere_, tolerance);
  Mesh other = sphere_;
  other.positions[7].x = std::nextafter(other.positions[7].x, 2);
  EXPECT_FALSE(find_simplified(other, tolerance));
  EXPECT_FALSE(find_simplified(sphere_, std::nextafter(tolerance, 1)));
  EXPECT_FALSE(find_simplified(sphere_, tolerance, 5));
}

TEST_F(MeshCache, RefusesTolerancesThatAreNone) {
  for (const double none : {0., -1., std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(simplify_cached(sphere_, none), Error);
  EXPECT_TRUE(files().empty());
}

TEST_F(MeshCache, ReplacesTruncatedFiles) {
  const CoarserMesh first = simplify_cached(sphere_, tolerance);
  const fs::path file = files().at(0);
  const std::uintmax_t whole = fs::file_size(file);
  for (const std::uintmax_t size : {whole - 1, whole / 2, std::uintmax_t{20}, std::uintmax_t{0}}) {
    fs::resize_file(file, size);
    EXPECT_FALSE(find_simplified(sphere_, tolerance)) << size;
    expect_same(simplify_cached(sphere_, tolerance), first);
    EXPECT_EQ(fs::file_size(file), whole);
  }
}

TEST_F(MeshCache, TakesNoDamagedFileForAGoodOne) {
  const CoarserMesh first = simplify_cached(sphere_, tolerance);
  const fs::path file = files().at(0);
  const std::uintmax_t size = fs::file_size(file);
  for (std::uintmax_t at = 0; at < size; at += 1 + size / 97) {  // header, arrays and hash
    std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
    stream.seekg(std::streamoff(at));
    const char byte = static_cast<char>(stream.get());
    stream.seekp(std::streamoff(at));
    stream.put(static_cast<char>(byte ^ 0x40));
    stream.close();
    EXPECT_FALSE(find_simplified(sphere_, tolerance)) << "byte " << at;
    stream.open(file, std::ios::binary | std::ios::in | std::ios::out);
    stream.seekp(std::streamoff(at));
    stream.put(byte);
  }
  expect_same(find_simplified(sphere_, tolerance).value(), first);
}

TEST_F(MeshCache, DoesWithoutAFolder) {
  const CoarserMesh first = simplify(sphere_, tolerance);
  const fs::path plain = cache_.write("plain", "a file, no folder");
  setenv("XDG_CACHE_HOME", plain.c_str(), 1);
  expect_same(simplify_cached(sphere_, tolerance), first);
  EXPECT_FALSE(find_simplified(sphere_, tolerance));
}

TEST_F(MeshCache, DropsWhatWasUnusedForLongest) {
  fs::create_directories(folder());
  const auto now = fs::file_time_type::clock::now();
  const auto make = [&](const char* name, std::uintmax_t size, int hours) {  // sparse files: they take no room
    const fs::path file = folder() / name;
    std::ofstream{file};
    fs::resize_file(file, size);
    fs::last_write_time(file, now - std::chrono::hours(hours));
    return file;
  };
  const fs::path oldest = make("oldest.mesh", mesh_cache_limit / 2, 3), old = make("old.mesh", mesh_cache_limit / 2, 2);
  const fs::path foreign = make("other.program", mesh_cache_limit, 9);
  simplify_cached(sphere_, tolerance);
  EXPECT_FALSE(fs::exists(oldest));
  EXPECT_TRUE(fs::exists(old));
  EXPECT_TRUE(fs::exists(foreign));  // not ours to remove
  EXPECT_TRUE(find_simplified(sphere_, tolerance));
}

TEST_F(MeshCache, TakesAHitForAUse) {
  simplify_cached(sphere_, tolerance);
  const fs::path file = files().at(0);
  const auto before = fs::file_time_type::clock::now() - std::chrono::hours(5);
  fs::last_write_time(file, before);
  EXPECT_TRUE(find_simplified(sphere_, tolerance));
  EXPECT_GT(fs::last_write_time(file), before + std::chrono::hours(1));
}

}  // namespace
}  // namespace rayengine
