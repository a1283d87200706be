#include "engine/load/surface_distance.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <glm/geometric.hpp>

namespace rayengine {
namespace {

constexpr int most_cuts = 12;           // in four
constexpr double smallest_part = 0.25;  // in limits

double squared(const glm::dvec3& v) { return glm::dot(v, v); }

double to_segment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 along = b - a;
  const double length = squared(along);
  const double s = length > 0 ? std::clamp(glm::dot(p - a, along) / length, 0., 1.) : 0;
  return squared(p - (a + s * along));
}

Box widened(const FloatBox& box) { return {glm::dvec3(box.lower), glm::dvec3(box.upper)}; }

BinaryBvh build_over(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles) {
  std::vector<Box> boxes(triangles.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (const glm::dvec3& corner : corners(positions, triangles[i])) boxes[i].add(corner);
  return build_bvh(boxes, 4);
}

}  // namespace

double longest_edge(const Corners& c) {
  return std::sqrt(std::max({squared(c[1] - c[0]), squared(c[2] - c[1]), squared(c[0] - c[2])}));
}

glm::dvec3 area_vector(const Corners& c) { return glm::cross(c[1] - c[0], c[2] - c[0]); }

std::array<Corners, 4> quartered(const Corners& c) {
  const glm::dvec3 ab = 0.5 * (c[0] + c[1]), bc = 0.5 * (c[1] + c[2]), ca = 0.5 * (c[2] + c[0]);
  return {{{c[0], ab, ca}, {ab, c[1], bc}, {ca, bc, c[2]}, {ab, bc, ca}}};
}

namespace {

/// What every point's distance from a triangle needs.
struct Plane {
  glm::dvec3 ab, ac, n;  // two sides, and their product
  double area;           // squared length of n
  bool has_normal;

  explicit Plane(const Corners& t)
      : ab(t[1] - t[0]),
        ac(t[2] - t[0]),
        n(glm::cross(ab, ac)),
        area(squared(n)),
        has_normal(area > 1e-20 * squared(ab) * squared(ac)) {}

  double height(const glm::dvec3& ap) const { return glm::dot(ap, n); }
  bool is_over(const glm::dvec3& ap) const {
    const double v = glm::dot(glm::cross(ap, ac), n), w = glm::dot(glm::cross(ab, ap), n);
    return v >= 0 && w >= 0 && v + w <= area;
  }
};

double to_edges(const glm::dvec3& p, const Corners& t) {
  return std::min({to_segment(p, t[0], t[1]), to_segment(p, t[1], t[2]), to_segment(p, t[2], t[0])});
}

}  // namespace

double squared_distance(const glm::dvec3& p, const Corners& t) {
  const Plane plane(t);
  const glm::dvec3 ap = p - t[0];
  if (!plane.has_normal || !plane.is_over(ap)) return to_edges(p, t);
  const double height = plane.height(ap);
  return height * height / plane.area;
}

bool is_within(const Corners& from, const Corners& to, double square) {
  const Plane plane(to);
  for (const glm::dvec3& p : from) {
    const glm::dvec3 ap = p - to[0];
    const double height = plane.height(ap);
    if (plane.has_normal && height * height > square * plane.area) return false;
    if (!(plane.has_normal && plane.is_over(ap)) && to_edges(p, to) > square) return false;
  }
  return true;
}

double squared_reach(const Corners& from, const Corners& to) {
  return std::max({squared_distance(from[0], to), squared_distance(from[1], to), squared_distance(from[2], to)});
}

MeshSurface::MeshSurface(std::span<const glm::dvec3> positions, std::vector<glm::uvec3> triangles)
    : positions_(positions), triangles_(std::move(triangles)), bvh_(build_over(positions_, triangles_)) {}

struct MeshSurface::Query {
  const Corners& part;
  double limit;
  glm::dvec3 middle;  // of the part, in the frame of the BVH as is the square
  double squared_radius;
};

std::optional<double> MeshSurface::first_near(std::uint32_t at, const Query& query) const {
  const BinaryBvh::Node& node = bvh_.nodes[at];
  if (node.leaf()) {
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const double square = squared_reach(query.part, corners(positions_, triangles_[bvh_.order[i]]));
      if (square <= query.limit * query.limit) return std::sqrt(square);
    }
    return {};
  }
  std::array<std::pair<double, std::uint32_t>, 2> children{{{0, at + 1}, {0, node.right}}};
  for (auto& [distance, child] : children) distance = widened(bvh_.nodes[child].box).squared_distance(query.middle);
  if (children[1].first < children[0].first) std::swap(children[0], children[1]);
  for (const auto& [distance, child] : children)
    if (distance <= query.squared_radius)
      if (const auto found = first_near(child, query)) return found;
  return {};
}

/// Of the one triangle that was found to be near all of the part.
std::optional<double> MeshSurface::near_one(const Corners& part, double limit) const {
  if (triangles_.empty()) return {};
  const double radius = limit * bvh_.frame.scale * (1 + 1e-9);
  const glm::dvec3 middle = ((part[0] + part[1] + part[2]) / 3. - bvh_.frame.center) * bvh_.frame.scale;
  return first_near(0, {part, limit, middle, radius * radius});
}

std::optional<double> MeshSurface::bound(const Corners& part, double limit, int cuts) const {
  if (const auto reach = near_one(part, limit)) return reach;
  if (cuts == most_cuts || longest_edge(part) < smallest_part * limit) return {};
  for (const glm::dvec3& corner : part)
    if (!near_one({corner, corner, corner}, limit)) return {};
  double largest = 0;
  for (const Corners& quarter : quartered(part)) {
    const std::optional<double> its = bound(quarter, limit, cuts + 1);
    if (!its) return {};
    largest = std::max(largest, *its);
  }
  return largest;
}

std::optional<double> MeshSurface::bound(const Corners& triangle, double limit) const {
  return bound(triangle, limit, 0);
}

Excursion excursion(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles,
                    const MeshSurface& surface, double limit) {
  std::vector<double> bounds(triangles.size());
  tbb::parallel_for(std::size_t{0}, triangles.size(), [&](std::size_t i) {
    bounds[i] = surface.bound(corners(positions, triangles[i]), limit).value_or(infinity);
  });
  Excursion result;
  for (std::uint32_t i = 0; i < bounds.size(); ++i)
    if (bounds[i] <= limit)
      result.distance = std::max(result.distance, bounds[i]);
    else
      result.strays.push_back(i);
  return result;
}

}  // namespace rayengine
