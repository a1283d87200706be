#include <algorithm>

#include "engine/plan/recognise/cloud.h"
#include "engine/plan/recognise/fit.h"
#include "engine/plan/recognise/symmetric.h"

namespace rayengine::surfaces {
namespace {

/// What all edges of the outline are at right angles to, as nearly as can be.
glm::dvec3 axis_of_outline(const Region& region, double extent) {
  Matrix<3> m{};
  each_outline_edge(region, [&](const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 e = (to - from) / extent;
    add_outer<3>(m, {e.x, e.y, e.z});
  });
  const Vector<3> axis = eigen(m).vectors[0];
  return {axis[0], axis[1], axis[2]};
}

struct Rings {
  double low = infinity, high = -infinity;  // heights of the outline's vertices
  double mean = 0;                          // of the region's corners
};

Rings rings(const Region& region, const WorldToObject& map) {
  Rings r;
  each_outline_edge(region, [&](const glm::dvec3& at, const glm::dvec3&) {
    const double z = map.point(at).z;
    r.low = std::min(r.low, z), r.high = std::max(r.high, z);
  });
  double count = 0;
  each_corner(region, [&](const glm::dvec3& at) { r.mean += map.point(at).z, ++count; });
  r.mean /= count;
  return r;
}

}  // namespace

std::optional<Candidate> fit_zone(const Region& region) {
  std::optional<Candidate> found = fit_sphere(region);
  if (!found || !is_invertible(found->to_world)) return {};
  const double radius = found->to_world.linear[0][0];
  found->to_world.linear = radius * frame_about(axis_of_outline(region, radius));
  const Rings r = rings(region, inverse(found->to_world));
  if (!(r.low <= r.high && std::abs(r.low) < 1 && std::abs(r.high) < 1)) return {};
  constexpr double one_ring = 1e-3;
  if (r.high - r.low > one_ring)
    found->clip = {r.low, r.high};
  else if (r.mean > r.high)
    found->clip = {0.5 * (r.low + r.high), 1};
  else
    found->clip = {-1, 0.5 * (r.low + r.high)};
  found->inward = faces_inward(region, *found);
  return found;
}

}  // namespace rayengine::surfaces
