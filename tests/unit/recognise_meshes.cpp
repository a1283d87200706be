#include "recognise_meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/measure/stress/shapes.h"
#include "engine/measure/tessellate.h"
#include "recognised_distance.h"

namespace rayengine::test {

void append(Mesh& mesh, const Mesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const glm::uvec3& t : other.triangles) mesh.triangles.push_back(t + first);
}

Mesh soup(const Mesh& mesh) {
  Mesh result;
  for (const glm::uvec3& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(result.positions.size());
    for (int k = 0; k < 3; ++k) result.positions.push_back(mesh.positions[t[k]]);
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

Mesh flipped(Mesh mesh) {
  for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
  return mesh;
}

Mesh sphere(double radius, const glm::dvec3& center, int subdivisions) {
  return stability::mapped(subdivided_sphere(subdivisions), {glm::dmat3(radius), center});
}

Mesh tessellated(const QuadricShape& shape, int level, const Affine& pose) {
  return mesh_of(*tessellate(*stability::alone(shape, pose), level)->geometry, 0);
}

Mesh waves(int cells) {
  return grid(cells, cells,
              [](double u, double v) { return glm::dvec3(u, v, 0.1 * std::sin(9 * u) * std::cos(7 * v)); });
}

void expect_kept(const Mesh& mesh, const Recognition& found, double tolerance, std::size_t samples) {
  std::vector<int> seen(mesh.triangles.size(), 0);
  for (const std::uint32_t t : found.rest) ++seen[t];
  for (const RecognisedQuadric& q : found.quadrics) {
    for (const std::uint32_t t : q.triangles) ++seen[t];
    EXPECT_TRUE(std::ranges::is_sorted(q.triangles));
    EXPECT_GE(q.triangles.size(), fewest_triangles);
    EXPECT_LE(q.residual, tolerance);
    const Distances d = measured(mesh, q, samples);
    EXPECT_GT(d.points, 0u) << to_string(q.shape.type) << " of " << q.triangles.size();
    EXPECT_LE(d.to_quadric, q.residual * (1 + 1e-9));
    EXPECT_LE(d.to_mesh, q.residual * (1 + 1e-9));
  }
  EXPECT_TRUE(std::ranges::all_of(seen, [](int n) { return n == 1; }));
  EXPECT_TRUE(std::ranges::is_sorted(found.rest));
}

}  // namespace rayengine::test
