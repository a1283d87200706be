#include <array>

#include "engine/measure/tessellate.h"

namespace rayengine {
namespace {

double value(const QuadricMatrix& m, const glm::dvec3& p) {
  return p.x * (m[0] * p.x + 2 * (m[1] * p.y + m[2] * p.z + m[3])) + p.y * (m[4] * p.y + 2 * (m[5] * p.z + m[6])) +
         p.z * (m[7] * p.z + 2 * m[8]) + m[9];
}

class Marcher {
 public:
  explicit Marcher(const QuadricMatrix& matrix) : matrix_(matrix) {}

  void cut(const std::array<glm::dvec3, 4>& tetrahedron) {
    std::array<glm::dvec3, 4> inside, outside;
    std::size_t in = 0, out = 0;
    for (const glm::dvec3& p : tetrahedron) (value(matrix_, p) < 0 ? inside[in++] : outside[out++]) = p;
    if (in == 1) add({cross(inside[0], outside[0]), cross(inside[0], outside[1]), cross(inside[0], outside[2])});
    if (out == 1) add({cross(inside[0], outside[0]), cross(inside[1], outside[0]), cross(inside[2], outside[0])});
    if (in != 2) return;
    const glm::dvec3 a = cross(inside[0], outside[0]), b = cross(inside[0], outside[1]),
                     c = cross(inside[1], outside[1]), d = cross(inside[1], outside[0]);
    add({a, b, c});
    add({a, c, d});
  }

  Mesh mesh;

 private:
  /// Where the edge meets the surface, to the last bits; the same from every tetrahedron at it.
  glm::dvec3 cross(glm::dvec3 inside, glm::dvec3 outside) const {
    for (int step = 0; step < 60; ++step) {
      const glm::dvec3 middle = 0.5 * (inside + outside);
      (value(matrix_, middle) < 0 ? inside : outside) = middle;
    }
    return outside;
  }

  void add(const std::array<glm::dvec3, 3>& corners) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), corners.begin(), corners.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
  }

  const QuadricMatrix& matrix_;
};

/// A cube's corners by the bits of their numbers, x lowest; the tetrahedra share its diagonal from 0 to 7.
constexpr int tetrahedra[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};

}  // namespace

Mesh form_mesh(const GeneralForm& form, int cells) {
  Marcher marcher(form.matrix);
  const glm::dvec3 size = form.box.size() / static_cast<double>(cells);
  const auto corner = [&](const glm::ivec3& cell, int bits) {
    return form.box.lower + size * glm::dvec3(cell.x + (bits & 1), cell.y + (bits >> 1 & 1), cell.z + (bits >> 2));
  };
  for (int z = 0; z < cells; ++z)
    for (int y = 0; y < cells; ++y)
      for (int x = 0; x < cells; ++x)
        for (const auto& t : tetrahedra)
          marcher.cut(
              {corner({x, y, z}, t[0]), corner({x, y, z}, t[1]), corner({x, y, z}, t[2]), corner({x, y, z}, t[3])});
  return marcher.mesh;
}

}  // namespace rayengine
