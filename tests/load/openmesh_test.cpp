// OpenMesh's readers as a witness to ours: independent, though rounded to float and without the faces that a half-edge
// mesh cannot hold, so that only sound meshes can be compared.
#include <gtest/gtest.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <set>

#include "engine/load/load.h"
#include "tests/data.h"
#include "tests/temporary.h"

namespace rayengine {
namespace {

using Witness = OpenMesh::TriMesh_ArrayKernelT<>;
using Corners = std::array<std::array<float, 3>, 3>;

/// A triangle by its positions, begun at the least, since readers may number vertices and turn faces as they like.
Corners turned(Corners c) {
  std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
  return c;
}

std::vector<Corners> triangles(const Mesh& mesh) {
  std::vector<Corners> list;
  for (const glm::uvec3& t : mesh.triangles) {
    Corners corners;
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c) corners[std::size_t(k)][std::size_t(c)] = static_cast<float>(mesh.positions[t[k]][c]);
    list.push_back(turned(corners));
  }
  return list;
}

std::vector<Corners> triangles(const Witness& mesh) {
  std::vector<Corners> list;
  for (const auto face : mesh.faces()) {
    Corners corners;
    std::size_t k = 0;
    for (const auto vertex : mesh.fv_range(face)) {
      const auto& p = mesh.point(vertex);
      corners[k++] = {p[0], p[1], p[2]};
    }
    list.push_back(turned(corners));
  }
  return list;
}

void expect_same(const std::filesystem::path& file) {
  std::vector<std::string> notes;
  Witness witness;
  ASSERT_TRUE(OpenMesh::IO::read_mesh(witness, file.string())) << file;
  EXPECT_EQ(triangles(load_mesh(file, notes)), triangles(witness)) << file;
}

TEST(OpenMeshAgrees, OnThirdPartyMeshes) {
  for (const char* name : {"bun_zipper.ply", "koala.obj", "spot.obj", "wingnut.obj"}) {
    DATA_OR_SKIP(file, std::string("mesh/") + name);
    expect_same(file);
  }
}

TEST(OpenMeshAgrees, OnWhatItWritesItself) {
  const test::TemporaryFolder folder;
  Witness cube;
  std::vector<Witness::VertexHandle> v;
  for (int i = 0; i < 8; ++i)
    v.push_back(cube.add_vertex({float(i & 1) / 3, float(i >> 1 & 1) / 7, float(i >> 2) + 1e-7f}));
  const int sides[][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& s : sides) cube.add_face(v[s[0]], v[s[1]], v[s[2]]), cube.add_face(v[s[0]], v[s[2]], v[s[3]]);
  omlog().disable();
  using Options = OpenMesh::IO::Options;
  const std::pair<const char*, Options> files[] = {
      {"a.ply", Options::Default}, {"b.ply", Options::Binary}, {"c.ply", Options(Options::Binary | Options::MSB)},
      {"a.stl", Options::Default}, {"b.stl", Options::Binary}, {"a.obj", Options::Default},
      {"a.off", Options::Default}};
  for (const auto& [name, options] : files) {
    ASSERT_TRUE(OpenMesh::IO::write_mesh(cube, (folder.path() / name).string(), options, 9)) << name;
    expect_same(folder.path() / name);
  }
}

}  // namespace
}  // namespace rayengine
