#include "engine/load/polygon.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numeric>

#include "accel/tracer.h"

namespace rayengine {
namespace {

using Points = std::vector<glm::dvec2>;

/// Twice the signed area of a triangle, positive when it turns counter-clockwise.
double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
}

/// The normal after Newell, as long as twice the area.
glm::dvec3 area_normal(std::span<const glm::dvec3> polygon) {
  glm::dvec3 sum(0);
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    sum += glm::cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
  return sum;
}

/// Leaves out the axis that the polygon faces most, so that coordinates stay exact and it turns counter-clockwise.
Points project(std::span<const glm::dvec3> polygon) {
  const glm::dvec3 normal = area_normal(polygon), size = glm::abs(normal);
  const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(u, v);
  Points points;
  points.reserve(polygon.size());
  for (const glm::dvec3& p : polygon) points.emplace_back(p[u], p[v]);
  return points;
}

/// True when every corner turns left and the polygon goes round once.
bool is_convex_outline(const Points& p) {
  const std::size_t n = p.size();
  int turns_of_sign = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const glm::dvec2 &a = p[i], &b = p[(i + 1) % n], &c = p[(i + 2) % n];
    if (!(turn(a, b, c) > 0)) return false;
    turns_of_sign += (b.x - a.x < 0) != (c.x - b.x < 0);
  }
  return turns_of_sign == 2;
}

class EarClipper {
 public:
  explicit EarClipper(const Points& points) : p_(points), next_(size()), previous_(size()), is_ear_(size()) {
    std::iota(next_.begin(), next_.end(), 1u);
    next_.back() = 0;
    std::iota(previous_.begin() + 1, previous_.end(), 0u);
    previous_.front() = static_cast<std::uint32_t>(size() - 1);
    for (std::uint32_t i = 0; i < size(); ++i)
      if (!is_convex(i)) reflex_.push_back(i);
    for (std::uint32_t i = 0; i < size(); ++i) update(i);
  }

  std::vector<glm::uvec3> clip() {
    std::vector<glm::uvec3> triangles;
    std::uint32_t corner = 0;
    for (std::size_t left = size(); left > 3; --left) {
      corner = choose(corner);
      triangles.emplace_back(previous_[corner], corner, next_[corner]);
      corner = remove(corner);
    }
    triangles.emplace_back(previous_[corner], corner, next_[corner]);
    return triangles;
  }

 private:
  std::size_t size() const { return p_.size(); }

  bool is_convex(std::uint32_t i) const { return turn(p_[previous_[i]], p_[i], p_[next_[i]]) > 0; }

  bool is_removed(std::uint32_t i) const { return next_[i] == i; }

  /// A convex corner is an ear when no corner that is not convex lies in its triangle. Corners that only touch its own
  /// do not count: holes that a bridge joins to the outline have such.
  bool is_ear(std::uint32_t i) const {
    if (!is_convex(i)) return false;
    const glm::dvec2 &a = p_[previous_[i]], &b = p_[i], &c = p_[next_[i]];
    return std::none_of(reflex_.begin(), reflex_.end(), [&](std::uint32_t r) {
      const glm::dvec2& q = p_[r];
      return turn(a, b, q) >= 0 && turn(b, c, q) >= 0 && turn(c, a, q) >= 0 && q != a && q != b && q != c;
    });
  }

  void update(std::uint32_t i) {
    is_ear_[i] = is_ear(i);
    if (is_ear_[i]) ears_.push_back(i);
  }

  /// The next ear; without one (the polygon crosses itself, or has no area) the corner at hand.
  std::uint32_t choose(std::uint32_t at_hand) {
    while (!ears_.empty()) {
      const std::uint32_t ear = ears_.back();
      ears_.pop_back();
      if (is_ear_[ear]) return ear;
    }
    return at_hand;
  }

  std::uint32_t remove(std::uint32_t i) {
    const std::uint32_t before = previous_[i], after = next_[i];
    next_[before] = after;
    previous_[after] = before;
    next_[i] = i;
    is_ear_[i] = false;
    std::erase_if(reflex_,
                  [&](std::uint32_t r) { return is_removed(r) || ((r == before || r == after) && is_convex(r)); });
    update(before);
    update(after);
    return after;
  }

  const Points& p_;
  std::vector<std::uint32_t> next_, previous_;  // a ring of the corners that are left
  std::vector<std::uint32_t> reflex_;           // the corners left that are not convex
  std::vector<std::uint32_t> ears_;             // holds all ears, and some that no longer are
  std::vector<bool> is_ear_;
};

std::vector<glm::uvec3> fan(std::size_t size) {
  std::vector<glm::uvec3> triangles;
  for (std::uint32_t i = 1; i + 1 < size; ++i) triangles.emplace_back(0, i, i + 1);
  return triangles;
}

}  // namespace

std::vector<glm::uvec3> triangulate(std::span<const glm::dvec3> polygon) {
  if (polygon.size() == 3) return fan(3);
  const Points points = project(polygon);
  if (is_convex_outline(points)) return fan(polygon.size());
  if (polygon.size() > largest_concave_polygon)
    throw Error("a polygon that is not convex has " + std::to_string(polygon.size()) +
                " vertices; cut it into pieces of at most " + std::to_string(largest_concave_polygon));
  return EarClipper(points).clip();
}

}  // namespace rayengine
