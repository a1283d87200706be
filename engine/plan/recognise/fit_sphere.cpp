#include <glm/geometric.hpp>
#include <limits>

#include "engine/plan/recognise/cloud.h"
#include "engine/plan/recognise/fit.h"
#include "engine/plan/recognise/round_number.h"
#include "engine/plan/recognise/symmetric.h"

namespace rayengine::surfaces {
// |p|^2 = 2 c.p + k is linear in the centre c and in k = r^2 - |c|^2; about the mean of the points k separates. Source:
// Coope, "Circle fitting by linear and nonlinear least squares" (1993), in three dimensions.
std::optional<Candidate> fit_sphere(const Region& region) {
  const Sample sample(region);
  const Cloud& points = sample.cloud;
  if (!points.usable()) return {};
  const double count = 3. * static_cast<double>(sample.triangles.size());
  Matrix<3> m{};
  Vector<3> b{};
  double squares = 0;
  each_corner(sample.patch, [&](const glm::dvec3& at) {
    const glm::dvec3 p = points.local(at);
    const double size = glm::dot(p, p);
    squares += size;
    add_outer<3>(m, {p.x, p.y, p.z});
    for (int i = 0; i < 3; ++i) b[i] += 0.5 * p[i] * size;
  });
  const auto c = solve(m, b, 1e-6);
  if (!c) return {};
  const glm::dvec3 center((*c)[0], (*c)[1], (*c)[2]);
  const double radius = std::sqrt(squares / count + glm::dot(center, center));
  double noise = std::numeric_limits<double>::epsilon();
  each_corner(sample.patch, [&](const glm::dvec3& at) {
    noise = std::max(noise, std::abs(glm::length(points.local(at) - center) - radius));
  });
  Candidate found;
  found.to_world.origin = points.world(center);
  const double allowance = noise * points.extent;
  for (int i = 0; i < 3; ++i) found.to_world.origin[i] = round_number(found.to_world.origin[i], allowance);
  found.to_world.linear = glm::dmat3(round_number(points.extent * radius, allowance));
  return found;
}

}  // namespace rayengine::surfaces
