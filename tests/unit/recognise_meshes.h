#pragma once

#include <string>

#include "engine/plan/recognise/recognise.h"

// Meshes to recognise quadrics in, and what is promised of the result.
namespace rayengine::test {

/// One mesh after the other in one.
void append(Mesh& mesh, const Mesh& other);

/// Every triangle with corners of its own, as STL files have them.
Mesh soup(const Mesh& mesh);

/// Every triangle turned over.
Mesh flipped(Mesh mesh);

/// The unit sphere in triangles, moved and scaled.
Mesh sphere(double radius, const glm::dvec3& center, int subdivisions = 3);

/// A quadric in triangles.
Mesh tessellated(const QuadricShape& shape, int level, const Affine& pose = {});

/// What a function makes of a grid of cells, [0, 1]^2.
template <class Surface>
Mesh grid(int columns, int rows, Surface surface) {
  Mesh mesh;
  for (int y = 0; y <= rows; ++y)
    for (int x = 0; x <= columns; ++x)
      mesh.positions.push_back(surface(static_cast<double>(x) / columns, static_cast<double>(y) / rows));
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const std::uint32_t at = y * (columns + 1) + x, above = at + columns + 1;
      mesh.triangles.push_back({at, at + 1, above + 1});
      mesh.triangles.push_back({at, above + 1, above});
    }
  return mesh;
}

/// A free form: no quadric.
Mesh waves(int cells);

/// The promise, and that every triangle is accounted for once.
void expect_kept(const Mesh& mesh, const Recognition& found, double tolerance, std::size_t samples = 400);

}  // namespace rayengine::test
