#include "engine/load/mesh_cache.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <numbers>

#include "accel/tracer.h"
#include "engine/load/mesh_files.h"
#include "engine/load/mesh_tools.h"
#include "engine/load/recognition_cache.h"
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
  const fs::path oldest = make("oldest.mesh", mesh_files_limit / 2, 3), old = make("old.mesh", mesh_files_limit / 2, 2);
  const fs::path foreign = make("other.program", mesh_files_limit, 9);
  simplify_cached(sphere_, tolerance);
  EXPECT_FALSE(fs::exists(oldest));
  EXPECT_TRUE(fs::exists(old));
  EXPECT_TRUE(fs::exists(foreign));  // not ours to remove
  EXPECT_TRUE(find_simplified(sphere_, tolerance));
}

void expect_same(const Recognition& a, const Recognition& b) {
  EXPECT_EQ(a.rest, b.rest);
  ASSERT_EQ(a.quadrics.size(), b.quadrics.size());
  for (std::size_t i = 0; i < a.quadrics.size(); ++i) {
    const RecognisedQuadric &p = a.quadrics[i], &q = b.quadrics[i];
    EXPECT_EQ(p.shape.type, q.shape.type);
    EXPECT_EQ(p.shape.capped, q.shape.capped);
    EXPECT_EQ(p.shape.clip, q.shape.clip);
    EXPECT_EQ(p.shape.matrix, q.shape.matrix);
    ASSERT_EQ(p.shape.box.has_value(), q.shape.box.has_value());
    if (p.shape.box) {
      EXPECT_EQ(p.shape.box->lower, q.shape.box->lower);
      EXPECT_EQ(p.shape.box->upper, q.shape.box->upper);
    }
    EXPECT_TRUE(p.to_world.linear == q.to_world.linear && p.to_world.origin == q.to_world.origin);
    EXPECT_EQ(p.residual, q.residual);
  }
}

/// A tube without ends, its front inside, in one piece with a triangle that stays, beside a ball.
Mesh bore_and_ball() {
  Mesh mesh = subdivided_sphere(4);
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  constexpr std::uint32_t segments = 64;
  for (std::uint32_t i = 0; i < segments; ++i)
    for (const double z : {0., 2.}) {
      const double angle = 2 * std::numbers::pi * i / segments;
      mesh.positions.emplace_back(5 + std::cos(angle), std::sin(angle), z);
    }
  for (std::uint32_t i = 0; i < segments; ++i) {
    const std::uint32_t a = base + 2 * i, b = base + 2 * ((i + 1) % segments);
    mesh.triangles.emplace_back(a, a + 1, b);
    mesh.triangles.emplace_back(b, a + 1, b + 1);
  }
  mesh.positions.insert(mesh.positions.end(), {{9, 0, 0}, {9, 1, 0}, {9, 0, 1}});
  const auto last = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.triangles.emplace_back(last - 3, last - 2, last - 1);
  return mesh;
}

TEST_F(MeshCache, KeepsQuadricsThatWereFound) {
  const Mesh mesh = bore_and_ball();
  const Recognition found = recognise(mesh, tolerance);
  ASSERT_EQ(found.quadrics.size(), 2u);
  EXPECT_FALSE(find_recognised(mesh, tolerance, Pieces::parts));
  expect_same(recognise_cached(mesh, tolerance, Pieces::parts), found);
  expect_same(find_recognised(mesh, tolerance, Pieces::parts).value(), found);
  expect_same(recognise_cached(mesh, tolerance, Pieces::parts), found);
  EXPECT_FALSE(find_recognised(mesh, tolerance, Pieces::whole));
  EXPECT_FALSE(find_recognised(mesh, 2 * tolerance, Pieces::parts));
  EXPECT_FALSE(find_simplified(mesh, tolerance));
  ASSERT_EQ(files().size(), 1u);
  fs::resize_file(files().at(0), fs::file_size(files().at(0)) - 1);
  EXPECT_FALSE(find_recognised(mesh, tolerance, Pieces::parts));
}

TEST_F(MeshCache, GivesAPlanWhatWasFoundBefore) {
  Scene scene;
  GeometryBuilder builder;
  builder.add(bore_and_ball());
  scene.geometry = builder.build();
  const ModelPlan plan{.objects = {{0, Representation::recalled, tolerance}}};
  const MeshTools tools = cached_mesh_tools();
  EXPECT_TRUE(make_model(scene, plan, tools).replaced.empty());
  recognise_cached(bore_and_ball(), tolerance, Pieces::parts);
  const Model model = make_model(scene, plan, tools);
  ASSERT_EQ(model.replaced.size(), 1u);
  EXPECT_EQ(model.replaced[0].quadrics, 2u);
  EXPECT_EQ(model.replaced[0].triangles_left, 1u);
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
