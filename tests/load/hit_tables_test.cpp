// The answers of POV-Ray (NFF scenes) and CGAL (meshes) to 8,192 rays each, against ours: all of them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <sstream>

#include "cpu/embree_tracer.h"
#include "cpu/reference_tracer.h"
#include "engine/load/load.h"
#include "engine/measure/compare.h"
#include "tests/data.h"

namespace rayengine {
namespace {

constexpr double tolerance = 1e-9;  // of t, relative

/// One line: the ray and how many primitives it hits (NFF tables: whether it does), then t and a normal or a triangle.
struct Row {
  Ray ray;
  std::size_t hits = 0;
  double t = infinity;
  glm::dvec3 normal{0};
  std::uint32_t triangle = no_id;
};

bool read_row(const std::string& line, bool mesh, Row& row) {
  std::istringstream in(line);
  glm::dvec3 &o = row.ray.origin, &d = row.ray.direction;
  if (line.empty() || line[0] == '#' || !(in >> o.x >> o.y >> o.z >> d.x >> d.y >> d.z >> row.hits)) return false;
  if (row.hits > 0 && mesh) in >> row.t >> row.triangle;
  if (row.hits > 0 && !mesh) in >> row.t >> row.normal.x >> row.normal.y >> row.normal.z;
  return true;
}

struct Table {
  std::vector<Ray> rays;
  std::vector<Row> rows;
};

Table read_table(const std::filesystem::path& file, bool mesh) {
  Table table;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (Row row; read_row(line, mesh, row)) table.rows.push_back(row), table.rays.push_back(row.ray);
  return table;
}

std::string place(std::size_t i, const Row& row, const Hit& hit) {
  std::ostringstream text;
  text.precision(17);
  text << "ray " << i << ": table t " << row.t << ", ours " << hit.t << " object " << hit.object << " primitive "
       << hit.primitive;
  return text.str();
}

void expect_t(const Table& table, std::span<const Hit> hits) {
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Row& row = table.rows[i];
    ASSERT_EQ(hits[i].hit(), row.hits > 0) << place(i, row, hits[i]);
    if (hits[i].hit()) {
      ASSERT_NEAR(hits[i].t, row.t, tolerance * row.t) << place(i, row, hits[i]);
    }
  }
}

/// Single precision rays explain every difference between Embree and the oracle, and there are few of them.
void expect_embree_explained(const std::shared_ptr<const Geometry>& geometry, Tracer& oracle,
                             std::span<const Ray> rays) {
  const auto embree = make_embree_tracer(geometry, Precision::robust);
  const Comparison c = compare(*embree, oracle, *geometry, rays, RayClass::bounce);
  const std::uint64_t differences = c.wrong_ids + c.false_hits + c.false_misses;
  testing::Test::RecordProperty("differences", static_cast<int>(differences));
  EXPECT_EQ(c.beyond_bounds, 0u) << "first: ray " << (c.first.empty() ? 0 : c.first.front());
  EXPECT_LE(differences, rays.size() / 200);
}

class HitTable : public testing::TestWithParam<const char*> {};

class NffTable : public HitTable {};
INSTANTIATE_TEST_SUITE_P(Scenes, NffTable,
                         testing::Values("spd/balls-s4", "spd/gears-s4", "spd/jacks-s3", "spd/lattice-s12",
                                         "spd/mount-s6", "spd/rings-s7", "spd/teapot-s12", "spd/tree-s11",
                                         "mol/1hpv.bs", "mol/1tii.bs"));

/// "spd/balls-s4" and ".hits.txt" give "spd-ref/balls-s4.hits.txt".
std::string reference_name(const std::string& name, const std::string& suffix) {
  const std::size_t slash = name.find('/');
  return name.substr(0, slash) + "-ref" + name.substr(slash) + suffix;
}

TEST_P(NffTable, IsAnsweredByTheOracleAndByEmbree) {
  const std::string name = GetParam();
  DATA_OR_SKIP(file, name + ".nff");
  DATA_OR_SKIP(hits_file, reference_name(name, ".hits.txt"));
  const Table table = read_table(hits_file, false);
  ASSERT_EQ(table.rows.size(), 8192u);
  const auto geometry = load_nff(file).geometry;
  const auto oracle = make_reference_tracer(geometry);
  std::vector<Hit> hits(table.rays.size());
  oracle->closest(table.rays, hits, RayClass::primary);
  expect_t(table, hits);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!hits[i].hit()) continue;
    const double cosine = glm::dot(glm::dvec3(hits[i].normal), table.rows[i].normal);
    EXPECT_NEAR(std::abs(cosine), 1, 1e-5) << place(i, table.rows[i], hits[i]);
  }
  expect_embree_explained(geometry, *oracle, table.rays);
}

class MeshTable : public HitTable {};
INSTANTIATE_TEST_SUITE_P(Scenes, MeshTable,
                         testing::Values("bun_zipper.ply", "dragon_vrip_res2.ply", "koala.obj", "netgen-frame.stl",
                                         "occt-motor.stl", "spot.obj", "wingnut.obj"));

TEST_P(MeshTable, IsAnsweredByTheOracleAndByEmbree) {
  const std::string name = GetParam();
  DATA_OR_SKIP(file, "mesh/" + name);
  DATA_OR_SKIP(hits_file, "mesh-ref/" + name.substr(0, name.find('.')) + ".hits.txt");
  const Table table = read_table(hits_file, true);
  ASSERT_EQ(table.rows.size(), 8192u);
  std::vector<std::string> notes;
  GeometryBuilder builder;
  builder.add(load_mesh(file, notes));
  const auto geometry = builder.build();
  const auto oracle = make_reference_tracer(geometry);
  std::vector<Hit> hits(table.rays.size());
  oracle->closest(table.rays, hits, RayClass::primary);
  expect_t(table, hits);
  const HitLists lists = oracle->all(table.rays);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    EXPECT_EQ(lists.offsets[i + 1] - lists.offsets[i], table.rows[i].hits) << place(i, table.rows[i], hits[i]);
    const bool decided = hits[i].hit() && !(hits[i].status & status_tie);
    EXPECT_TRUE(!decided || hits[i].primitive == table.rows[i].triangle) << place(i, table.rows[i], hits[i]);
  }
  expect_embree_explained(geometry, *oracle, table.rays);
}

}  // namespace
}  // namespace rayengine
