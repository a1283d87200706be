#pragma once

#include <glm/geometric.hpp>

#include "accel/frame.h"
#include "engine/plan/recognise/candidate.h"

namespace rayengine::surfaces {

/// Calls visit(corner) for every corner of every triangle: vertices as often as they are used.
template <class Visit>
void each_corner(const Patch& patch, Visit visit) {
  for (const std::uint32_t t : patch.triangles)
    for (int k = 0; k < 3; ++k) visit(patch.corner(t, k));
}

/// Calls visit(from, to) for every edge of the outline.
template <class Visit>
void each_outline_edge(const Region& region, Visit visit) {
  for (const std::uint32_t t : region.triangles)
    for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h)
      if (region.is_outline(h))
        visit(region.mesh.positions[region.mesh.from(h)], region.mesh.positions[region.mesh.to(h)]);
}

/// Calls visit(normal) for every triangle; the normal's length is twice the area.
template <class Visit>
void each_normal(const Patch& patch, Visit visit) {
  for (const std::uint32_t t : patch.triangles) {
    const glm::dvec3 a = patch.corner(t, 0);
    visit(glm::cross(patch.corner(t, 1) - a, patch.corner(t, 2) - a));
  }
}

/// Every so many-th triangle of a patch, where it has thousands: fits need no more, and proofs go through all of them.
inline std::vector<std::uint32_t> thinned(const Patch& patch) {
  constexpr std::size_t enough = 4096;
  std::vector<std::uint32_t> few;
  for (std::size_t i = 0, step = patch.triangles.size() / enough + 1; i < patch.triangles.size(); i += step)
    few.push_back(patch.triangles[i]);
  return few;
}

/// Takes a region's corners to numbers of about 1, however large, small or far off they are, so that squares and sums
/// of them lose nothing.
struct Cloud {
  glm::dvec3 mean{0};
  double extent = 0;  ///< the largest distance from the mean along an axis

  explicit Cloud(const Patch& patch) {
    const glm::dvec3 near = patch.corner(patch.triangles[0], 0);  // differences from here are small
    glm::dvec3 sum(0);
    Box box;
    each_corner(patch, [&](const glm::dvec3& p) { sum += p - near, box.add(p); });
    mean = near + sum / (3. * static_cast<double>(patch.triangles.size()));
    const glm::dvec3 reach = glm::max(box.upper - mean, mean - box.lower);
    extent = std::max({reach.x, reach.y, reach.z});
  }

  bool usable() const { return extent > 0 && std::isfinite(extent); }
  glm::dvec3 local(const glm::dvec3& p) const { return (p - mean) / extent; }
  glm::dvec3 world(const glm::dvec3& p) const { return mean + extent * p; }
};

/// Enough of a region to fit to.
struct Sample {
  std::vector<std::uint32_t> triangles;
  Patch patch;
  Cloud cloud;

  explicit Sample(const Region& region) : triangles(thinned(region)), patch{region.mesh, triangles}, cloud(patch) {}
  Sample(const Sample&) = delete;
  Sample& operator=(const Sample&) = delete;
};

/// What a quadric's ten coefficients are multiplied with, those off the diagonal taken twice.
inline std::array<double, 10> monomials(const glm::dvec3& p) {
  return {p.x * p.x, p.y * p.y, p.z * p.z, p.x * p.y, p.x * p.z, p.y * p.z, p.x, p.y, p.z, 1};
}

}  // namespace rayengine::surfaces
