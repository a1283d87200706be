#include "engine/load/simplify.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <random>
#include <set>

#include "accel/tracer.h"
#include "engine/load/load.h"
#include "engine/load/surface_distance.h"
#include "engine/measure/tessellate.h"
#include "engine/plan/coarsen/coarsen.h"
#include "tests/data.h"
#include "tests/load/expect_error.h"

namespace rayengine {
namespace {

using test::expect_error;

/// Points all over a mesh's triangles that have an area: corners, and random ones.
std::vector<glm::dvec3> samples(const Mesh& mesh, std::size_t count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<glm::dvec3> points;
  for (std::size_t i = 0; i < count; ++i) {
    const Corners c = corners(mesh.positions, mesh.triangles[random() % mesh.triangles.size()]);
    if (glm::cross(c[1] - c[0], c[2] - c[0]) == glm::dvec3(0)) continue;
    const double s = std::sqrt(unit(random)), t = unit(random);
    points.push_back(i % 4 ? (1 - s) * c[0] + s * (1 - t) * c[1] + s * t * c[2] : c[i % 3]);
  }
  return points;
}

/// How far a box around the triangle is at least: along the axis where that is most.
double boxes_distance(const glm::dvec3& p, const Corners& t) {
  double most = 0;
  for (int i = 0; i < 3; ++i) {
    const auto [low, high] = std::minmax({t[0][i], t[1][i], t[2][i]});
    most = std::max({most, low - p[i], p[i] - high});
  }
  return most;
}

/// By trying every triangle that may be nearer: slow, and beholden to nothing that is tested.
double distance(const glm::dvec3& p, const Mesh& mesh) {
  double least = infinity;
  for (const glm::uvec3& t : mesh.triangles)
    if (const Corners c = corners(mesh.positions, t); boxes_distance(p, c) <= std::sqrt(least))
      least = std::min(least, squared_distance(p, c));
  return std::sqrt(least);
}

Mesh moved(Mesh mesh, const glm::dvec3& by) {
  for (glm::dvec3& p : mesh.positions) p += by;
  return mesh;
}

/// From near the origin, so that far-off samples are not rounded.
double farthest(Mesh from, Mesh to, std::size_t count) {
  if (from.positions.empty() || from.triangles.empty()) return 0;
  const glm::dvec3 origin = from.positions[0];
  from = moved(std::move(from), -origin), to = moved(std::move(to), -origin);
  double most = 0;
  for (const glm::dvec3& p : samples(from, count)) most = std::max(most, distance(p, to));
  return most;
}

/// Expects every promise of simplify, and gives what came out.
CoarserMesh expect_kept(const Mesh& mesh, double tolerance, std::size_t count = 200) {
  const CoarserMesh result = simplify(mesh, tolerance);
  EXPECT_LE(result.distance, tolerance);
  EXPECT_LE(result.mesh.triangles.size(), mesh.triangles.size());
  EXPECT_EQ(result.mesh.normals.size(), mesh.normals.empty() ? 0 : result.mesh.positions.size());
  const double slack = 1e-12 * tolerance;  // for the roundings of the samples
  EXPECT_LE(farthest(mesh, result.mesh, count), result.distance + slack);
  EXPECT_LE(farthest(result.mesh, mesh, count), result.distance + slack);
  return result;
}

/// A square of n by n cells in the plane z = 0, each vertex raised by `height`.
template <class Height>
Mesh sheet(std::uint32_t n, Height height) {
  Mesh mesh;
  for (std::uint32_t y = 0; y <= n; ++y)
    for (std::uint32_t x = 0; x <= n; ++x) {
      mesh.positions.push_back({double(x) / n, double(y) / n, height(double(x) / n, double(y) / n)});
      const std::uint32_t at = y * (n + 1) + x;
      if (x == n || y == n) continue;
      mesh.triangles.push_back({at, at + 1, at + n + 2});
      mesh.triangles.push_back({at, at + n + 2, at + n + 1});
    }
  return mesh;
}
Mesh flat_sheet(std::uint32_t n) {
  return sheet(n, [](double, double) { return 0.; });
}
Mesh noisy_sheet(std::uint32_t n, double noise) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> up(-noise, noise);
  return sheet(n, [&](double, double) { return up(random); });
}

void append(Mesh& mesh, const Mesh& other, const glm::dvec3& by) {
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  for (const glm::dvec3& p : other.positions) mesh.positions.push_back(p + by);
  for (const glm::uvec3& t : other.triangles) mesh.triangles.push_back(t + base);
}

TEST(Simplify, RefusesTolerancesThatAreNone) {
  const Mesh mesh = flat_sheet(2);
  for (const double tolerance : {0., -1., std::numeric_limits<double>::quiet_NaN(), infinity})
    expect_error([&] { simplify(mesh, tolerance); }, "tolerance", "give a finite number above 0");
}

TEST(Simplify, RefusesBrokenMeshes) {
  Mesh mesh = flat_sheet(2);
  mesh.triangles.push_back({0, 1, 99});
  expect_error([&] { simplify(mesh, 1); }, "a mesh", "names vertex 99");
  mesh = flat_sheet(2);
  mesh.positions[1].x = std::numeric_limits<double>::quiet_NaN();
  expect_error([&] { simplify(mesh, 1); }, "a mesh", "not finite");
}

TEST(Simplify, LeavesWhatHasNothingToDrop) {
  Mesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
  for (const Mesh& mesh : {tetrahedron, Mesh{}, Mesh{{{0, 0, 0}}, {}, {}}}) {
    const CoarserMesh same = simplify(mesh, 1e-3);
    EXPECT_EQ(same.distance, 0);
    EXPECT_EQ(same.mesh.positions, mesh.positions);
    EXPECT_EQ(same.mesh.triangles, mesh.triangles);
  }
}

TEST(Simplify, DropsTheSmallTrianglesOfASphere) {
  const Mesh sphere = subdivided_sphere(5);  // edges of 0.05 and less
  EXPECT_LT(expect_kept(sphere, 0.04).mesh.triangles.size(), sphere.triangles.size() / 2);
}

TEST(Simplify, ClustersWhatIsTooMuchForTheDecimater) {
  const Mesh sphere = subdivided_sphere(6);  // 32,768 triangles
  const CoarserMesh clustered = simplify(sphere, 0.06, 0);
  EXPECT_LT(clustered.mesh.triangles.size(), sphere.triangles.size() / 10);
  EXPECT_LE(farthest(sphere, clustered.mesh, 100), clustered.distance);
  EXPECT_LE(farthest(clustered.mesh, sphere, 100), clustered.distance);
}

TEST(Simplify, KeepsTheCornersAndEdgesOfAnOpenSheet) {
  const Mesh sheet = flat_sheet(40);
  const CoarserMesh result = expect_kept(sheet, 0.015, 1000);
  EXPECT_LT(result.mesh.triangles.size(), 200u);
  for (const glm::dvec3& corner : {glm::dvec3(0, 0, 0), {1, 0, 0}, {0, 1, 0}, {1, 1, 0}})
    EXPECT_LE(distance(corner, result.mesh), result.distance);
}

TEST(Simplify, FillsNoHolesThatAreWiderThanTheTolerance) {
  Mesh holed = flat_sheet(40);
  std::erase_if(holed.triangles, [&](const glm::uvec3& t) {
    return glm::length(holed.positions[t.x] - glm::dvec3(0.5, 0.5, 0)) < 0.15;
  });
  const CoarserMesh result = expect_kept(holed, 0.03, 1000);
  EXPECT_LT(result.mesh.triangles.size(), holed.triangles.size() / 4);
  EXPECT_GT(distance({0.5, 0.5, 0}, result.mesh), 0.1);
}

TEST(Simplify, KeepsShellsApartThatAreFartherThanTheTolerance) {
  Mesh shells = flat_sheet(40);
  append(shells, flat_sheet(40), {0, 0, 0.07});
  const CoarserMesh result = expect_kept(shells, 0.03);
  for (const glm::dvec3& p : result.mesh.positions) EXPECT_TRUE(p.z == 0 || p.z == 0.07) << p.z;
  expect_kept(shells, 0.2);  // within the tolerance they may be one
}

/// A tube round x, of three sides.
Mesh hair(double radius) {
  Mesh mesh;
  for (std::uint32_t k = 0; k < 200; ++k) {
    for (int side = 0; side < 3; ++side)
      mesh.positions.push_back({0.005 * k, radius * std::cos(2.1 * side), radius * std::sin(2.1 * side)});
    for (std::uint32_t side = 0; k > 0 && side < 3; ++side) {
      const std::uint32_t a = 3 * k + side, b = 3 * k + (side + 1) % 3;
      mesh.triangles.push_back({a - 3, b - 3, a});
      mesh.triangles.push_back({b - 3, b, a});
    }
  }
  return mesh;
}

TEST(Simplify, KeepsThinTubesAndSpikes) {
  expect_kept(hair(0.001), 0.01, 1000);  // ten times as wide as it is
}

TEST(Simplify, LeavesNoiseBeyondTheTolerance) {
  const Mesh noisy = noisy_sheet(40, 0.2);
  EXPECT_GT(expect_kept(noisy, 0.004).mesh.triangles.size(), noisy.triangles.size() * 9 / 10);
}

TEST(Simplify, StaysWithinWhereNoiseIsNearTheTolerance) {
  for (const double noise : {0.003, 0.01, 0.02, 0.04}) expect_kept(noisy_sheet(40, noise), 0.015);
}

TEST(Simplify, KeepsNonManifoldFaces) {
  Mesh fins = flat_sheet(40);  // with a third face at every edge along a line
  for (std::uint32_t x = 0; x < 40; ++x) {
    const auto at = static_cast<std::uint32_t>(fins.positions.size());
    fins.positions.push_back({(x + 0.5) / 40, 0.5, 0.3});
    fins.triangles.push_back({20 * 41 + x, 20 * 41 + x + 1, at});
  }
  const CoarserMesh result = expect_kept(fins, 0.005, 1000);
  EXPECT_LE(distance({0.5 / 40, 0.5, 0.3}, result.mesh), result.distance);
}

TEST(Simplify, TakesDuplicatesFlipsAndTrianglesWithoutArea) {
  Mesh mesh = subdivided_sphere(4);
  const std::vector<glm::uvec3> once = mesh.triangles;
  for (std::size_t i = 0; i < once.size(); i += 3) mesh.triangles.push_back(once[i]);
  for (std::size_t i = 0; i < once.size(); i += 5) mesh.triangles.push_back({once[i].x, once[i].z, once[i].y});
  for (std::uint32_t i = 0; i + 2 < 300; ++i) mesh.triangles.push_back({i, i, i + 2});
  mesh.triangles.push_back({7, 7, 7});
  expect_kept(mesh, 0.06);
}

TEST(Simplify, TakesSoupsOfTrianglesThatShareNoVertices) {
  const Mesh sphere = subdivided_sphere(5);
  Mesh soup;
  for (const glm::uvec3& t : sphere.triangles)
    for (int k = 0; k < 3; ++k) soup.positions.push_back(sphere.positions[t[k]]);
  for (std::uint32_t i = 0; i < soup.positions.size(); i += 3) soup.triangles.push_back({i, i + 1, i + 2});
  EXPECT_LT(expect_kept(soup, 0.1).mesh.triangles.size(), soup.triangles.size() / 3);
}

TEST(Simplify, IsAsGoodFarOffAsNear) {
  const Mesh near = subdivided_sphere(4);
  const std::size_t count = simplify(near, 0.05).mesh.triangles.size();
  for (const double far : {1e6, 1e9}) {
    const Mesh mesh = moved(near, {far, -far, far});
    const CoarserMesh result = expect_kept(mesh, 0.05);
    EXPECT_LT(result.mesh.triangles.size(), 2 * count);
  }
  expect_kept(moved(near, {1e15, 0, 0}), 0.05);  // where positions are steps of an eighth
}

TEST(Simplify, TakesTinyAndHugeUnits) {
  for (const double scale : {1e-30, 1e30}) {
    Mesh mesh = subdivided_sphere(4);
    for (glm::dvec3& p : mesh.positions) p *= scale;
    EXPECT_LT(expect_kept(mesh, 0.05 * scale).mesh.triangles.size(), mesh.triangles.size() / 2);
  }
}

TEST(Simplify, LeavesWhatATinyToleranceCannotTell) {
  const Mesh mesh = subdivided_sphere(3);
  EXPECT_EQ(simplify(mesh, 1e-300).mesh.triangles, mesh.triangles);
}

TEST(Simplify, CarriesNormalsWithTheirVertices) {
  Mesh mesh = subdivided_sphere(5);
  for (const glm::dvec3& p : mesh.positions) mesh.normals.push_back(glm::vec3(p));
  const CoarserMesh result = expect_kept(mesh, 0.02);
  ASSERT_LT(result.mesh.positions.size(), mesh.positions.size());
  for (std::size_t i = 0; i < result.mesh.positions.size(); ++i)
    EXPECT_EQ(result.mesh.normals[i], glm::vec3(result.mesh.positions[i]));
}

TEST(Simplify, FacesAsBefore) {
  const CoarserMesh result = simplify(subdivided_sphere(5), 0.04);
  for (const glm::uvec3& t : result.mesh.triangles) {
    const Corners c = corners(result.mesh.positions, t);
    EXPECT_GT(glm::dot(glm::cross(c[1] - c[0], c[2] - c[0]), c[0]), 0);
  }
}

TEST(Simplify, IsTheSameEachTime) {
  const Mesh sphere = subdivided_sphere(6);
  const CoarserMesh a = simplify(sphere, 0.01), b = simplify(sphere, 0.01);
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
  EXPECT_EQ(a.mesh.positions, b.mesh.positions);
  EXPECT_EQ(a.distance, b.distance);
}

TEST(Simplify, KeepsItsPromiseOnAModelledMesh) {
  DATA_OR_SKIP(file, "mesh/spot.obj");
  std::vector<std::string> notes;
  const Mesh cow = load_mesh(file, notes);  // 1.9 long, with normals
  EXPECT_LT(expect_kept(cow, 0.08, 100).mesh.triangles.size(), cow.triangles.size() / 2);
}

std::optional<CoarserMesh> coarsened(const Mesh& mesh, double tolerance) {
  GeometryBuilder builder;
  builder.add(mesh);
  return coarsen(*builder.build(), 0, tolerance);
}

/// Whether there is a coarser mesh; expects that it keeps its bound.
std::optional<CoarserMesh> expect_coarsened(const Mesh& mesh, double tolerance) {
  const auto result = coarsened(mesh, tolerance);
  if (!result) return {};
  EXPECT_LE(result->distance, tolerance);
  EXPECT_LE(2 * result->mesh.triangles.size(), mesh.triangles.size());
  EXPECT_EQ(result->mesh.normals.size(), mesh.normals.empty() ? 0 : result->mesh.positions.size());
  const double slack = 1e-12 * tolerance;
  EXPECT_LE(farthest(mesh, result->mesh, 300), result->distance + slack);
  EXPECT_LE(farthest(result->mesh, mesh, 300), result->distance + slack);
  return result;
}

TEST(Coarsen, MakesLargerTrianglesOfSmallOnes) {
  Mesh sphere = subdivided_sphere(6);
  for (const glm::dvec3& p : sphere.positions) sphere.normals.push_back(glm::vec3(p));
  const auto result = expect_coarsened(sphere, 0.06);
  ASSERT_TRUE(result);
  EXPECT_LT(result->mesh.triangles.size(), sphere.triangles.size() / 5);
  for (const glm::uvec3& t : result->mesh.triangles) {  // none folded over
    const Corners c = corners(result->mesh.positions, t);
    EXPECT_GT(glm::dot(glm::cross(c[1] - c[0], c[2] - c[0]), c[0]), 0);
  }
  EXPECT_TRUE(expect_coarsened(flat_sheet(100), 0.05));
}

TEST(Coarsen, KeepsItsBoundWhateverTheMesh) {
  Mesh shells = flat_sheet(60), doubled = subdivided_sphere(4), soup;
  append(shells, flat_sheet(60), {0, 0, 0.03});
  const std::vector<glm::uvec3> once = doubled.triangles;
  for (std::size_t i = 0; i < once.size(); i += 2) doubled.triangles.push_back({once[i].x, once[i].z, once[i].y});
  doubled.triangles.push_back({7, 7, 7});
  const Mesh sphere = subdivided_sphere(4);
  for (const glm::uvec3& t : sphere.triangles) {
    const auto at = static_cast<std::uint32_t>(soup.positions.size());
    for (int k = 0; k < 3; ++k) soup.positions.push_back(sphere.positions[t[k]]);
    soup.triangles.push_back({at, at + 1, at + 2});
  }
  int coarsened = 0;
  for (const Mesh& mesh : {shells, doubled, soup, hair(0.001), hair(0.02), noisy_sheet(60, 0.01), noisy_sheet(60, 0.1),
                           moved(sphere, {1e9, 0, 0})})
    for (const double tolerance : {0.005, 0.02, 0.05, 0.2, 10.})
      coarsened += expect_coarsened(mesh, tolerance).has_value();
  EXPECT_GE(coarsened, 7);
}

/// A sheet of n squares a side without the triangles that have a corner within `radius` of its middle; those stay as
/// vertices of none.
Mesh holed_sheet(std::uint32_t n, double radius) {
  Mesh mesh = flat_sheet(n);
  const glm::dvec3 middle = (mesh.positions.front() + mesh.positions.back()) / 2.;
  std::erase_if(mesh.triangles, [&](const glm::uvec3& t) {
    for (int k = 0; k < 3; ++k)
      if (glm::distance(mesh.positions[t[k]], middle) < radius) return true;
    return false;
  });
  return mesh;
}

TEST(Coarsen, KeepsHolesThoughVerticesLieInThem) {
  for (const double radius : {0.03, 0.06, 0.1, 0.2, 0.3}) EXPECT_TRUE(expect_coarsened(holed_sheet(120, radius), 0.05));
}

TEST(Coarsen, KeepsItsBoundOnBumpsOfAnySize) {
  int coarsened = 0;
  for (const double waves : {3., 10., 40.})
    for (const double height : {0.003, 0.03}) {
      Mesh bumpy = subdivided_sphere(5);
      for (glm::dvec3& p : bumpy.positions)
        p *= 1 + height * std::sin(waves * p.x) * std::sin(waves * p.y + 1) * std::sin(waves * p.z);
      for (const double tolerance : {0.05, 0.1}) coarsened += expect_coarsened(bumpy, tolerance).has_value();
    }
  EXPECT_GE(coarsened, 5);
}

TEST(Coarsen, LeavesWhatHasNothingToDrop) {
  const Mesh sphere = subdivided_sphere(3);
  for (const double tolerance : {1e-300, 1e-6, 0.01}) EXPECT_FALSE(coarsened(sphere, tolerance)) << tolerance;
  EXPECT_FALSE(coarsened(Mesh{}, 1));
  EXPECT_FALSE(coarsened(moved(sphere, {1e17, 0, 0}), 0.1));
  for (const double tolerance : {0., -1., std::numeric_limits<double>::quiet_NaN(), infinity})
    EXPECT_THROW(coarsened(sphere, tolerance), Error);
}

TEST(Coarsen, IsTheSameEachTime) {
  const Mesh sphere = subdivided_sphere(6);
  const auto a = coarsened(sphere, 0.03), b = coarsened(sphere, 0.03);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->mesh.triangles, b->mesh.triangles);
  EXPECT_EQ(a->mesh.positions, b->mesh.positions);
}

TEST(SurfaceDistance, IsThatOfTheNearestPoint) {
  const Corners triangle{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}};
  EXPECT_DOUBLE_EQ(squared_distance({0.5, 0.5, 3}, triangle), 9);
  EXPECT_DOUBLE_EQ(squared_distance({1, -2, 0}, triangle), 4);
  EXPECT_DOUBLE_EQ(squared_distance({-3, -4, 0}, triangle), 25);
  EXPECT_DOUBLE_EQ(squared_distance({2, 2, 1}, triangle), 3);
  EXPECT_DOUBLE_EQ(squared_distance({3, 1, 0}, {{{0, 0, 0}, {2, 0, 0}, {1, 0, 0}}}), 2);
  EXPECT_DOUBLE_EQ(squared_distance({1, 2, 2}, {{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}), 9);
}

TEST(SurfaceDistance, BoundsWhatIsNearAndNamesWhatStrays) {
  const Mesh low = flat_sheet(4);
  Mesh high = moved(flat_sheet(7), {0, 0, 0.1});
  const MeshSurface surface(low.positions, low.triangles);
  const Excursion near = excursion(high.positions, high.triangles, surface, 0.101);
  EXPECT_TRUE(near.strays.empty());
  EXPECT_GE(near.distance, 0.1);
  EXPECT_LE(near.distance, 0.101);
  EXPECT_EQ(excursion(high.positions, high.triangles, surface, 0.099).strays.size(), high.triangles.size());
  high.positions.push_back({0.5, 0.5, 5});
  high.triangles.push_back({0, 1, static_cast<std::uint32_t>(high.positions.size() - 1)});
  const std::vector<std::uint32_t> last{static_cast<std::uint32_t>(high.triangles.size() - 1)};
  EXPECT_EQ(excursion(high.positions, high.triangles, surface, 0.101).strays, last);
}

}  // namespace
}  // namespace rayengine
