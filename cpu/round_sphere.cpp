#include "cpu/round_sphere.h"

#include <cmath>
#include <glm/matrix.hpp>

namespace rayengine {
std::optional<RoundSphere> round_sphere(const Quadric& quadric) {
  if (quadric.type != QuadricType::sphere || std::isfinite(quadric.zmin) || std::isfinite(quadric.zmax)) return {};
  const glm::dmat3 m = glm::transpose(quadric.to_object.linear) * quadric.to_object.linear;
  const double scale = m[0][0], slack = 1e-9 * scale;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (!(std::abs(m[i][j] - (i == j ? scale : 0)) <= slack)) return {};
  return RoundSphere{quadric.to_object.origin, 1 / std::sqrt(scale)};
}

}  // namespace rayengine
