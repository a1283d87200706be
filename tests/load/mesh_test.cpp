#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <random>

#include "accel/tracer.h"
#include "engine/load/load.h"
#include "tests/data.h"
#include "tests/load/expect_error.h"
#include "tests/temporary.h"

namespace rayengine {
namespace {

using test::expect_error;

class MeshFile : public testing::Test {
 protected:
  Mesh load(const std::string& name, std::string_view content) {
    notes.clear();
    return load_mesh(folder.write(name, content), notes);
  }

  void fails(const std::string& name, std::string_view content, const std::string& part) {
    expect_error([&] { load(name, content); }, name, part);
  }

  test::TemporaryFolder folder;
  std::vector<std::string> notes;
};

template <class T>
void append(std::string& bytes, T value, std::endian order = std::endian::native) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (order != std::endian::native) std::reverse(raw, raw + sizeof(T));
  bytes.append(raw, sizeof(T));
}

std::string ply_header(const std::string& format, int vertices, int faces, const std::string& type = "double") {
  return "ply\nformat " + format + " 1.0\ncomment of ours\nelement vertex " + std::to_string(vertices) + "\nproperty " +
         type + " x\nproperty " + type + " y\nproperty " + type + " z\nelement face " + std::to_string(faces) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

std::string binary_ply(std::endian order) {
  std::string bytes = ply_header(order == std::endian::little ? "binary_little_endian" : "binary_big_endian", 4, 2);
  for (const double x : {0.1, 0.2, 0.3, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 1e-300}) append(bytes, x, order);
  append(bytes, std::uint8_t{3});
  for (const int i : {0, 1, 2}) append(bytes, i, order);
  append(bytes, std::uint8_t{4});
  for (const int i : {3, 2, 1, 0}) append(bytes, i, order);
  return bytes;
}

std::string binary_stl(std::uint32_t promised, const std::vector<glm::vec3>& corners) {
  std::string bytes(80, ' ');
  append(bytes, promised);
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    bytes.append(12, '\0');
    for (std::size_t k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c) append(bytes, corners[i + k][c]);
    bytes.append(2, '\0');
  }
  return bytes;
}

const std::string ascii_stl =
    "solid a part\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0.1\n   vertex 1 0 0\n   vertex 0 1 0\n  endloop\n"
    " endfacet\n facet normal 0 0 1\n  outer loop\n   vertex 1 0 0\n   vertex 1 0 0\n   vertex -0 1 0\n  endloop\n"
    " endfacet\nendsolid\n";

TEST_F(MeshFile, KeepsDoublesOfEveryTextFormat) {
  const double x = 0.1, y = 1.00000000001;
  const std::string point = "0.1 1.00000000001 0\n1 0 0\n0 1 0\n";
  const Mesh meshes[] = {load("a.obj", "v 0.1 1.00000000001 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
                         load("a.off", "OFF 3 1 0\n" + point + "3 0 1 2\n"),
                         load("a.ply", ply_header("ascii", 3, 1, "float") + point + "3 0 1 2\n"),
                         load("a.stl",
                              "solid\nfacet normal 0 0 0\nouter loop\nvertex 0.1 1.00000000001 0\nvertex 1 0 0\n"
                              "vertex 0 1 0\nendloop\nendfacet\nendsolid")};
  for (const Mesh& mesh : meshes) {
    ASSERT_EQ(mesh.positions.size(), 3u);
    EXPECT_EQ(mesh.positions[0], glm::dvec3(x, y, 0));
    EXPECT_EQ(mesh.triangles, std::vector{glm::uvec3(0, 1, 2)});
    EXPECT_TRUE(mesh.normals.empty());
  }
}

TEST_F(MeshFile, CutsPolygonsAsFansInFileOrder) {
  const std::vector<glm::uvec3> expected = {{0, 1, 2}, {4, 3, 2}, {4, 2, 1}, {4, 1, 0}};
  const std::string points = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 2 1\n";
  EXPECT_EQ(load("a.off", "COFF\n# five\n5 2 0\n" + points + "3 0 1 2 255 0 0\n5 4 3 2 1 0\n").triangles, expected);
  EXPECT_EQ(load("a.ply", ply_header("ascii", 5, 2) + points + "3 0 1 2\n5 4 3 2 1 0\n").triangles, expected);
  EXPECT_EQ(load("a.obj",
                 "v 0 0 0\nv 1 0 0 1.0\nv 1 1 0 0.5 0.5 0.5\n# note\nv 0 1 0\ng a b\nv 0 2 1\nf 1 2 \\\n 3\n"
                 "usemtl red\nf -1/-1/ -2/7 -3 2/1 1\n"
                 "l 1 2 \\\n 3\n")
                .triangles,
            expected);
}

TEST_F(MeshFile, KeepsTheNumberOfFacesOfEveryKind) {
  // Of no area (twice), a duplicate turned round, and three faces on the edge of vertices 0 and 1.
  const Mesh mesh =
      load("a.obj",
           "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 2 0 0\nf 1 2 3\nf 1 1 2\nf 1 2 5\nf 1 3 2\nf 1 2 4\nf 1 2\n"
           "mtllib a.mtl\n");
  EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 0, 1}, {0, 1, 4}, {0, 2, 1}, {0, 1, 3}}));
  ASSERT_EQ(notes.size(), 3u);
  EXPECT_NE(notes[0].find("2 triangles of no area, 1 duplicate triangles, 5 boundary edges, 1 non-manifold edges"),
            std::string::npos)
      << notes[0];
  EXPECT_NE(notes[1].find("1 faces of fewer than three corners"), std::string::npos) << notes[1];
  EXPECT_NE(notes[2].find("materials"), std::string::npos) << notes[2];
}

TEST_F(MeshFile, SaysNothingOfASoundMesh) {
  load("a.off", "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
  EXPECT_TRUE(notes.empty()) << notes[0];
}

TEST_F(MeshFile, ReadsBinaryPlyOfEitherByteOrder) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const Mesh mesh = load("a.ply", binary_ply(order));
    ASSERT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.positions[0], glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(mesh.positions[3].z, 1e-300);
    EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {3, 2, 1}, {3, 1, 0}}));
  }
}

TEST_F(MeshFile, PassesOverOtherElementsAndPropertiesOfPly) {
  const Mesh mesh =
      load("a.ply",
           "ply\r\nformat ascii 1.0\r\nobj_info x\r\nelement camera 1\r\nproperty float a\r\nproperty list "
           "uchar int b\r\nelement vertex 3\r\nproperty uchar red\r\nproperty float z\r\nproperty float y\r\n"
           "property float x\r\nelement face 1\r\nproperty uchar flag\r\nproperty list uint8 uint32 "
           "vertex_index\r\nproperty list uchar float texcoord\r\nend_header\r\n"
           "7 2 5 6\r\n255 1 2 3\r\n255 4 5 6\r\n255 7 8 0\r\n1 3 0 1 2 2 0.5 0.5\r\n");
  EXPECT_EQ(mesh.positions, (std::vector<glm::dvec3>{{3, 2, 1}, {6, 5, 4}, {0, 8, 7}}));
  EXPECT_EQ(mesh.triangles, std::vector{glm::uvec3(0, 1, 2)});
}

TEST_F(MeshFile, ReadsStlAndWeldsEqualPositions) {
  const std::vector<glm::vec3> corners = {{0, 0, 0.1f}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 0, 0}, {-0.0f, 1, 0}};
  std::string named_solid = binary_stl(2, corners);
  named_solid.replace(0, 5, "solid");
  for (const Mesh& mesh :
       {load("a.stl", binary_stl(2, corners)), load("b.stl", named_solid), load("c.stl", ascii_stl)}) {
    EXPECT_EQ(mesh.positions.size(), 3u);
    EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {1, 1, 2}}));
  }
}

TEST_F(MeshFile, KeepsNormalsOnePerVertex) {
  const Mesh ply =
      load("a.ply",
           "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
           "property float nx\nproperty float ny\nproperty float nz\nelement face 1\n"
           "property list uchar int vertex_indices\nend_header\n"
           "0 0 0 0 0 2\n1 0 0 nan 0 1\n0 1 0 0 0 0\n3 0 1 2\n");
  EXPECT_EQ(ply.normals, (std::vector<glm::vec3>{{0, 0, 1}, {0, 0, 0}, {0, 0, 0}}));
  const Mesh off = load("a.off", "NOFF\n3 1 0\n0 0 0 0 3 0\n1 0 0 0 1 0\n0 1 0 0 1 0\n3 0 1 2\n");
  EXPECT_EQ(off.normals, std::vector<glm::vec3>(3, {0, 1, 0}));
}

TEST_F(MeshFile, SplitsVerticesWhoseCornersDisagree) {
  // The third normal repeats the first, so that it splits nothing; the last face has a corner without any.
  const Mesh mesh = load("a.obj",
                         "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\nvn 0 1 0\nvn 0 0 1\n"
                         "f 1//1 2//1 3//1\nf 1//3 2//2 4//2\nf 1/9/2 3//1 4\n");
  EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 4, 3}, {5, 2, 6}}));
  EXPECT_EQ(mesh.positions,
            (std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {0, 0, 0}, {0, 0, 1}}));
  const glm::vec3 y(0, 1, 0), z(0, 0, 1), none(0);
  EXPECT_EQ(mesh.normals, (std::vector<glm::vec3>{z, z, z, y, y, y, none}));
}

TEST_F(MeshFile, RejectsBadObj) {
  fails("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", ":4: index 4 is out of range: the file has 3 vertices");
  fails("a.obj", "v 0 0 0\nf 1 2 0\n", ":2: index");
  fails("a.obj", "v 0 0 0\nf 1 1 -2\n", ":2: index -2 is out of range");
  fails("a.obj", "v 0 0 0\nf 1 1 99999999999999999999\n", ":2: expected a whole number");
  fails("a.obj", "v 0 0 0\nf 1//1 1//1 1//1\n", ":2: index 1 is out of range: the file has 0 normals");
  fails("a.obj", "v 0 0 nan\n", ":1: 'nan' is not a finite number");
  fails("a.obj", "v 0 0 1e999\n", ":1: '1e999' is not a finite number");
  fails("a.obj", "v 0 0\n", ":1: the line ends too early");
  fails("a.obj", "v 0 0 x\n", ":1: expected a number, found 'x'");
  fails("a.obj", "\x01\xff\n", " is not a statement of the OBJ format");
  fails("a.obj", "v 0 0 0\n", "holds no triangles");
  fails("a.obj", "", "holds no triangles");
}

TEST_F(MeshFile, RejectsBadPly) {
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
  fails("a.ply", "", "does not begin with 'ply'");
  fails("a.ply", "ply\nformat ascii 1.0\n", "ends too early");
  fails("a.ply", "ply\nformat octal 1.0\n", ":2: 'octal' is not a format");
  fails("a.ply", "ply\nelement vertex -1\n", ":2: cannot hold -1 elements");
  fails("a.ply", "ply\nproperty float x\n", ":2: a property before any element");
  fails("a.ply", "ply\nelement vertex 1\nproperty real x\n", ":3: 'real' is not a type");
  fails("a.ply", "ply\nbanana\n", ":2: expected a line of a PLY header");
  fails("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n", "x, y and z");
  fails("a.ply", ply_header("ascii", 2000000000, 1) + points, "do not fit into the file");
  fails("a.ply", ply_header("binary_little_endian", 3, 2000000000) + points, "do not fit into the file");
  fails("a.ply", ply_header("ascii", 3, 1) + points + "3 0 1 3\n", ":14: face 0 names vertex 3");
  fails("a.ply", ply_header("ascii", 3, 1) + points + "3 0 1 -1\n", "names vertex -1");
  fails("a.ply", ply_header("ascii", 3, 1) + points + "-3 0 1 1\n", "a list of -3");
  fails("a.ply", ply_header("ascii", 3, 1) + points + "4 0 1 2\n", "ends too early");
  fails("a.ply", ply_header("ascii", 3, 1) + "0 0 inf\n1 0 0\n0 1 0\n3 0 1 2\n", "not finite");
  fails("a.ply", ply_header("ascii", 3, 0) + points, "holds no triangles");
  const std::string whole = binary_ply(std::endian::little);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THROW(load("a.ply", std::string_view(whole).substr(0, size)), Error) << "of " << size << " bytes";
}

TEST_F(MeshFile, RejectsBadStl) {
  fails("a.stl", "", "no STL file");
  fails("a.stl", "soli", "no STL file");
  fails("a.stl", binary_stl(3, std::vector<glm::vec3>(6)), "3 facets do not fit");
  fails("a.stl", binary_stl(0xFFFFFFFF, std::vector<glm::vec3>(6)), "do not fit");
  fails("a.stl", binary_stl(0, {}), "holds no triangles");
  fails("a.stl", binary_stl(1, {{0, 0, 0}, {1, 0, 0}, {0, std::nanf(""), 0}}),
        "facet 0 has a coordinate that is not finite");
  fails("a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n",
        ":6: expected 'vertex'");
  fails("a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 z\n", ":4: expected a number");
  for (std::size_t size = 0; size < ascii_stl.size() - 1; size += 3)
    EXPECT_THROW(load("a.stl", std::string_view(ascii_stl).substr(0, size)), Error) << "of " << size << " bytes";
}

TEST_F(MeshFile, RejectsBadOff) {
  fails("a.off", "", ":1: the file ends too early");
  fails("a.off", "4OFF 1 1 1\n", "other kinds of OFF");
  fails("a.off", "OFF BINARY\n3 1 0\n", "binary OFF is not read");
  fails("a.off", "OFF\n4000000000 1 0\n0 0 0\n", ":2: 4000000000 vertices do not fit");
  fails("a.off", "OFF\n1 -1 0\n0 0 0\n", "-1 faces do not fit");
  fails("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", ":6: index 3 is out of range");
  fails("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n-3 0 1 3\n", ":6: a face of -3 corners");
  fails("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n", "ends too early");
}

TEST_F(MeshFile, RejectsWhatIsNoMeshFile) {
  fails("a.xyz", "", "is not a mesh that can be read");
  std::filesystem::create_directory(folder.path() / "folder.ply");
  expect_error([&] { load_mesh(folder.path() / "folder.ply", notes); }, "folder.ply", "is not a file");
  expect_error([&] { load_mesh(folder.path() / "none.ply", notes); }, "none.ply", "there is no such file");
}

TEST_F(MeshFile, NeverCrashesOnDamage) {
  std::mt19937 random(7);
  const std::pair<const char*, std::string> files[] = {
      {"a.ply", binary_ply(std::endian::little)},
      {"b.ply", ply_header("ascii", 3, 1) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
      {"a.stl", binary_stl(1, std::vector<glm::vec3>(3))},
      {"b.stl", ascii_stl},
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 -1/2/-1\n"},
      {"a.off", "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n"}};
  int loaded = 0, rejected = 0;
  for (const auto& [name, content] : files)
    for (int round = 0; round < 60; ++round) {
      std::string damaged = content;
      for (int i = 0; i < 1 + round % 4; ++i) damaged[random() % damaged.size()] = static_cast<char>(random());
      try {
        const Mesh mesh = load(name, damaged);
        for (const glm::uvec3& t : mesh.triangles)
          for (int k = 0; k < 3; ++k) ASSERT_LT(t[k], mesh.positions.size());
        ++loaded;
      } catch (const Error&) {
        ++rejected;
      }
    }
  EXPECT_GT(loaded, 20);
  EXPECT_GT(rejected, 20);
}

TEST_F(MeshFile, LoadsAMillionTriangles) {
  const int n = 708;
  std::string bytes = ply_header("binary_little_endian", n * n, 2 * (n - 1) * (n - 1), "float");
  for (int i = 0; i < n * n; ++i)
    for (const float x : {float(i % n), float(i / n), 0.0f}) append(bytes, x);
  for (int i = 0; i + n < n * n; ++i) {
    if (i % n == n - 1) continue;
    for (const auto& t : {glm::ivec3(i, i + 1, i + n), glm::ivec3(i + 1, i + n + 1, i + n)}) {
      append(bytes, std::uint8_t{3});
      append(bytes, t);
    }
  }
  const Mesh mesh = load("grid.ply", bytes);
  EXPECT_EQ(mesh.triangles.size(), 999'698u);
  EXPECT_EQ(mesh.triangles.back(), glm::uvec3(n * n - n - 1, n * n - 1, n * n - 2));
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("2828 boundary edges;"), std::string::npos) << notes[0];
}

struct ThirdParty {
  const char* name;
  std::size_t vertices;  // 0 where none are published, or normals split them
  std::size_t triangles;
  const char* note;
};

void PrintTo(const ThirdParty& mesh, std::ostream* stream) { *stream << mesh.name; }

class ThirdPartyMesh : public testing::TestWithParam<ThirdParty> {};

TEST_P(ThirdPartyMesh, HasThePublishedCounts) {
  const ThirdParty& expected = GetParam();
  DATA_OR_SKIP(file, std::string("mesh/") + expected.name);
  std::vector<std::string> notes;
  const Mesh mesh = load_mesh(file, notes);
  if (expected.vertices) {
    EXPECT_EQ(mesh.positions.size(), expected.vertices);
  }
  EXPECT_EQ(mesh.triangles.size(), expected.triangles);
  std::string all;
  for (const std::string& note : notes) all += note + "\n";
  EXPECT_NE(all.find(expected.note), std::string::npos) << all;
}

INSTANTIATE_TEST_SUITE_P(
    Data, ThirdPartyMesh,
    testing::Values(ThirdParty{"bun_zipper.ply", 35947, 69451, "223 boundary edges"},
                    ThirdParty{"dragon_vrip_res2.ply", 100250, 202520, "2534 non-manifold edges"},
                    ThirdParty{"koala.obj", 49999, 99994, ""}, ThirdParty{"spot.obj", 0, 23062, ""},
                    ThirdParty{"wingnut.obj", 3047, 6090, ""},
                    ThirdParty{"occt-motor.stl", 0, 13506, "14 boundary edges, 166 non-manifold edges"},
                    ThirdParty{"netgen-frame.stl", 0, 35168, "8 triangles of no area"}));

}  // namespace
}  // namespace rayengine
