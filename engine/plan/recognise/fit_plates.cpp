#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

#include "engine/plan/recognise/cloud.h"
#include "engine/plan/recognise/fit.h"
#include "engine/plan/recognise/round_number.h"
#include "engine/plan/recognise/symmetric.h"

namespace rayengine::surfaces {
namespace {

/// The mean normal, by area.
glm::dvec3 mean_normal(const Patch& patch, double extent) {
  glm::dvec3 sum(0);
  each_normal(patch, [&](const glm::dvec3& n) { sum += n / extent / extent; });
  for (int i = 0; i < 3; ++i)
    if (std::abs(sum[i]) <= 1e-9 * glm::length(sum)) sum[i] = 0;
  return sum / glm::length(sum);
}

/// Whether its corners are about as high as its middle: what is not is no plate, and its outline need not be looked at.
bool is_flat(const Patch& patch, const Cloud& cloud, const glm::dvec3& normal) {
  constexpr double most = 0.01;
  bool flat = true;
  each_corner(patch, [&](const glm::dvec3& p) { flat = flat && std::abs(glm::dot(cloud.local(p), normal)) < most; });
  return flat;
}

std::optional<Candidate> disk(const Region& region, const Cloud& cloud, const glm::dmat3& turn) {
  Matrix<3> m{};
  Vector<3> b{};
  each_outline_edge(region, [&](const glm::dvec3& at, const glm::dvec3&) {
    const glm::dvec3 p = cloud.local(at) * turn;
    const Vector<3> row{2 * p.x, 2 * p.y, 1};
    add_outer<3>(m, row);
    for (int i = 0; i < 3; ++i) b[i] += row[i] * (p.x * p.x + p.y * p.y);
  });
  const auto c = solve(m, b);
  if (!c) return {};
  const glm::dvec2 center((*c)[0], (*c)[1]);
  const double radius = std::sqrt((*c)[2] + glm::dot(center, center));
  double noise = std::numeric_limits<double>::epsilon(), height = 0, count = 0;
  each_outline_edge(region, [&](const glm::dvec3& at, const glm::dvec3&) {
    const glm::dvec3 p = cloud.local(at) * turn;
    noise = std::max(noise, std::abs(glm::length(glm::dvec2(p) - center) - radius));
    height += p.z, ++count;
  });
  const double r = round_number(cloud.extent * radius, noise * cloud.extent);
  Candidate found;
  found.type = QuadricType::disk;
  found.to_world = {{r * turn[0], r * turn[1], r * turn[2]}, cloud.world(turn * glm::dvec3(center, height / count))};
  for (int i = 0; i < 3; ++i) found.to_world.origin[i] = round_number(found.to_world.origin[i], noise * cloud.extent);
  return found;
}

/// With a side along the outline's longest edge.
std::optional<Candidate> rectangle(const Region& region, const Cloud& cloud, const glm::dvec3& normal) {
  glm::dvec3 longest(0);
  each_outline_edge(region, [&](const glm::dvec3& from, const glm::dvec3& to) {
    if (glm::length(to - from) > glm::length(longest)) longest = to - from;
  });
  const glm::dvec3 side = glm::cross(normal, longest);
  if (!(glm::length(side) > 0)) return {};
  const glm::dvec3 v = side / glm::length(side);
  const glm::dmat3 turn(glm::cross(v, normal), v, normal);
  Box box;
  each_corner(region, [&](const glm::dvec3& at) { box.add(cloud.local(at) * turn); });
  const glm::dvec3 half = 0.5 * cloud.extent * box.size();
  Candidate found;
  found.type = QuadricType::plane;
  found.to_world = {{half.x * turn[0], half.y * turn[1], std::max(half.x, half.y) * turn[2]},
                    cloud.world(turn * box.center())};
  return found;
}

}  // namespace

std::vector<Candidate> fit_plates(const Region& region) {
  const Sample sample(region);
  const auto& [few, patch, cloud] = sample;
  if (!cloud.usable()) return {};
  const glm::dvec3 normal = mean_normal(patch, cloud.extent);
  if (!(glm::length(normal) > 0) || !is_flat(patch, cloud, normal)) return {};
  std::vector<Candidate> result;
  if (const auto c = disk(region, cloud, frame_about(normal))) result.push_back(*c);
  if (const auto c = rectangle(region, cloud, normal)) result.push_back(*c);
  return result;
}

}  // namespace rayengine::surfaces
