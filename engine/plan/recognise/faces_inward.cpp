#include "engine/plan/recognise/cloud.h"
#include "engine/plan/recognise/fit.h"
#include "engine/plan/recognise/profile.h"

namespace rayengine::surfaces {

bool faces_inward(const Region& region, const Candidate& candidate) {
  if (!is_invertible(candidate.to_world)) return false;
  const WorldToObject map = inverse(candidate.to_world);
  const Fibres fibres = fibres_of(candidate.type, candidate.clip[0]);
  double flux = 0;
  for (const std::uint32_t t : region.triangles) {
    const glm::dvec3 a = map.point(region.corner(t, 0)), b = map.point(region.corner(t, 1)),
                     c = map.point(region.corner(t, 2));
    flux += glm::dot(glm::cross(b - a, c - a), fibre(candidate.type, fibres, (a + b + c) / 3.));
  }
  return flux < 0;
}

}  // namespace rayengine::surfaces
