#pragma once

#include <algorithm>
#include <vector>

#include "engine/plan/recognise/topology.h"

namespace rayengine::surfaces {

/// Calls visit(triangle) for neighbours across edges that are not sharp: at less than 50 degrees.
template <class Visit>
void each_smooth_neighbour(const Topology& mesh, std::uint32_t t, Visit visit) {
  constexpr double cosine = 0.64;
  for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
    const std::uint32_t twin = mesh.twins[h];
    if (twin != no_id && glm::dot(mesh.normals[t], mesh.normals[twin / 3]) > cosine) visit(twin / 3);
  }
}

/// At least `count` triangles that are reached from a seed in the fewest steps, or all that there are, where `accepts`
/// holds.
template <class Accepts>
std::vector<std::uint32_t> neighbourhood(const Topology& mesh, std::uint32_t seed, std::size_t count, Accepts accepts) {
  std::vector<std::uint32_t> patch{seed};
  for (std::size_t i = 0; i < patch.size() && patch.size() < count; ++i)
    each_smooth_neighbour(mesh, patch[i], [&](std::uint32_t t) {
      if (accepts(t) && std::ranges::find(patch, t) == patch.end()) patch.push_back(t);
    });
  return patch;
}

}  // namespace rayengine::surfaces
