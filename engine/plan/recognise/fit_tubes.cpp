#include <algorithm>
#include <numbers>

#include "engine/plan/recognise/fit.h"
#include "engine/plan/recognise/round_number.h"
#include "engine/plan/recognise/tube.h"

namespace rayengine::surfaces {
namespace {

/// A cone's apex may be this many times its height from its wide end: numbers as large arise where rays meet it.
constexpr double farthest_apex = 64;

/// The axis of coordinates that an axis is as well as on, in place of it.
glm::dvec3 snapped(const glm::dvec3& axis, double allowance) {
  for (int i = 0; i < 3; ++i) {
    glm::dvec3 exact(0);
    exact[i] = std::copysign(1, axis[i]);
    if (glm::length(axis - exact) <= allowance) return exact;
  }
  return axis;
}

struct Ends {
  double low = 0, high = 0;
};

/// Mean heights of the outline's level edges below and above the middle; where there are none, the region's own end.
Ends ends(const Region& region, const Cloud& cloud, const Tube& tube) {
  double lowest = infinity, highest = -infinity;
  each_corner(region, [&](const glm::dvec3& p) {
    const double z = tube.height(cloud.local(p));
    lowest = std::min(lowest, z), highest = std::max(highest, z);
  });
  double sums[2]{}, counts[2]{};
  each_outline_edge(region, [&](const glm::dvec3& from, const glm::dvec3& to) {
    const double a = tube.height(cloud.local(from)), b = tube.height(cloud.local(to));
    if (std::abs(a - b) > 0.5 * glm::length(cloud.local(from) - cloud.local(to))) return;
    const int side = a + b > lowest + highest;
    sums[side] += 0.5 * (a + b), ++counts[side];
  });
  return {counts[0] > 0 ? sums[0] / counts[0] : lowest, counts[1] > 0 ? sums[1] / counts[1] : highest};
}

glm::dvec3 rounded(const glm::dvec3& p, double allowance) {
  return {round_number(p.x, allowance), round_number(p.y, allowance), round_number(p.z, allowance)};
}

Candidate cylinder(const Cloud& cloud, const Tube& tube, const Ends& e, double allowance) {
  const double radius = round_number(cloud.extent * tube.radius, allowance);
  const double length = round_number(cloud.extent * (e.high - e.low), allowance);
  const glm::dmat3 turn = frame_about(tube.axis);
  Candidate c;
  c.type = QuadricType::cylinder;
  c.clip = {0, 1};
  c.to_world = {{radius * turn[0], radius * turn[1], length * turn[2]},
                rounded(cloud.world(tube.base + e.low * tube.axis), allowance)};
  return c;
}

/// Its wide end is at z = 1, its apex at the origin.
std::optional<Candidate> cone(const Cloud& cloud, Tube tube, Ends e, double allowance) {
  if (tube.slope < 0) {
    tube.axis = -tube.axis, tube.slope = -tube.slope;
    e = {-e.high, -e.low};
  }
  const double apex = -tube.radius / tube.slope, length = e.high - apex;
  if (!(length < farthest_apex * (e.high - e.low))) return {};
  const double radius = tube.slope * length, cut = (e.low - apex) / length;
  const glm::dmat3 turn = frame_about(tube.axis);
  Candidate c;
  c.type = QuadricType::cone;
  c.clip = {radius * std::abs(cut) * cloud.extent <= 2 * allowance ? 0 : cut, 1};
  if (c.clip[0] < 0) return {};
  c.to_world = {cloud.extent * glm::dmat3(radius * turn[0], radius * turn[1], length * turn[2]),
                rounded(cloud.world(tube.base + apex * tube.axis), allowance)};
  return c;
}

/// The part of a cylinder between the two sides of the widest gap in angle between its corners.
Candidate sector(const Region& region, Candidate c) {
  const WorldToObject map = inverse(c.to_world);
  std::vector<double> angles;
  each_corner(region, [&](const glm::dvec3& at) {
    const glm::dvec3 p = map.point(at);
    angles.push_back(std::atan2(p.y, p.x));
  });
  std::ranges::sort(angles);
  double from = angles.back() - 2 * std::numbers::pi, gap = angles.front() - from, middle = from + 0.5 * gap;
  for (std::size_t i = 1; i < angles.size(); ++i)
    if (angles[i] - angles[i - 1] > gap) gap = angles[i] - angles[i - 1], middle = angles[i - 1] + 0.5 * gap;
  c.half_angle = std::numbers::pi - 0.5 * gap;
  const double cosine = -std::cos(middle), sine = -std::sin(middle);  // x is opposite the gap
  const glm::dmat3 m = c.to_world.linear;
  c.to_world.linear = {cosine * m[0] + sine * m[1], cosine * m[1] - sine * m[0], m[2]};
  return c;
}

}  // namespace

std::vector<Candidate> fit_tubes(const Region& region) {
  const Sample sample(region);
  const auto& [few, patch, cloud] = sample;
  if (!cloud.usable()) return {};
  std::vector<FittedTube> tubes = fit_cylinder_and_cones(patch, cloud);
  // A cylinder is the simpler thing: it stands unless a cone is much nearer.
  std::ranges::stable_sort(tubes, {}, [](const FittedTube& t) { return t.tube.slope == 0 ? 0.1 * t.noise : t.noise; });
  std::vector<Candidate> result;
  for (auto& [tube, off] : tubes) {
    tube.axis = snapped(tube.axis, off);
    const Ends e = ends(region, cloud, tube);
    const double allowance = off * cloud.extent;
    std::optional<Candidate> c =
        tube.slope == 0 ? cylinder(cloud, tube, e, allowance) : cone(cloud, tube, e, allowance);
    if (!c || !is_invertible(c->to_world)) continue;
    c->inward = faces_inward(region, *c);
    result.push_back(*c);
    if (c->type == QuadricType::cylinder) result.push_back(sector(region, *c));
  }
  return result;
}

}  // namespace rayengine::surfaces
