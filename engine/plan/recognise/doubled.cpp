#include "engine/plan/recognise/doubled.h"

#include "engine/plan/recognise/candidate.h"
#include "engine/plan/recognise/near_points.h"

namespace rayengine::surfaces {
namespace {

/// Shells further apart than this share of their size are not two of one thing.
constexpr double share = 1. / 16;

double largest(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

}  // namespace

std::vector<bool> doubled(std::span<const Affine> ellipsoids, double distance) {
  NearPoints near;
  for (std::uint32_t i = 0; i < ellipsoids.size(); ++i)
    near.add(i, ellipsoids[i].origin, largest(lengths(ellipsoids[i])));
  near.sort();
  std::vector<bool> result(ellipsoids.size());
  for (std::uint32_t i = 0; i < ellipsoids.size(); ++i) {
    const Affine& map = ellipsoids[i];
    const glm::dvec3 size = lengths(map);
    near.each(map.origin, largest(size), [&](std::uint32_t k) {
      const glm::dvec3 apart =
          glm::max(glm::abs(map.origin - ellipsoids[k].origin), glm::abs(size - lengths(ellipsoids[k])));
      if (k != i && largest(apart) <= std::min(distance, share * largest(size))) result[i] = result[k] = true;
    });
  }
  return result;
}

}  // namespace rayengine::surfaces
