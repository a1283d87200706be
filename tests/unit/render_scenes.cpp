#include "render_scenes.h"

#include <cmath>
#include <numbers>

namespace rayengine::test {

Mesh globe(int rings) {
  Mesh mesh;
  const int columns = 2 * rings;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < columns; ++j) {
      const double polar = std::numbers::pi * i / rings, longitude = 2 * std::numbers::pi * j / columns;
      mesh.positions.emplace_back(std::sin(polar) * std::cos(longitude), std::sin(polar) * std::sin(longitude),
                                  std::cos(polar));
    }
  const auto index = [&](int i, int j) { return static_cast<std::uint32_t>(i * columns + j % columns); };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < columns; ++j) {
      if (i > 0) mesh.triangles.emplace_back(index(i, j), index(i + 1, j), index(i, j + 1));
      if (i + 1 < rings) mesh.triangles.emplace_back(index(i, j + 1), index(i + 1, j), index(i + 1, j + 1));
    }
  return mesh;
}

}  // namespace rayengine::test
