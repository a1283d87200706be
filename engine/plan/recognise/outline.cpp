#include "engine/plan/recognise/outline.h"

#include <algorithm>

#include "engine/plan/recognise/nearest.h"
#include "engine/plan/recognise/profile.h"

namespace rayengine::surfaces {
namespace {

class Comparison {
 public:
  Comparison(const Region& region, const Candidate& candidate, const WorldToObject& map)
      : region_(region), candidate_(candidate), map_(map), lengths_(lengths(candidate.to_world)) {}

  std::optional<Outline> run() {
    switch (candidate_.type) {
      case QuadricType::sphere: return is_whole_sphere(candidate_) ? whole() : zone();
      case QuadricType::plane:
      case QuadricType::saddle: return rectangle();
      default: break;
    }
    if (!is_whole_turn(candidate_)) return sector();
    return fibres_of(candidate_.type, candidate_.clip[0]) == Fibres::radial ? ends() : rim();
  }

 private:
  /// Calls visit(from, to), object space, for each half-edge of the outline while that holds.
  template <class Visit>
  bool each_edge(Visit visit) const {
    for (const std::uint32_t t : region_.triangles)
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h)
        if (region_.is_outline(h) && !visit(point(region_.mesh.from(h)), point(region_.mesh.to(h)))) return false;
    return true;
  }
  template <class Visit>
  void each_corner(Visit visit) const {
    for (const std::uint32_t t : region_.triangles)
      for (int k = 0; k < 3; ++k) visit(map_.point(region_.corner(t, k)));
  }
  glm::dvec3 point(std::uint32_t vertex) const { return map_.point(region_.mesh.positions[vertex]); }

  std::optional<Outline> whole() const {
    return each_edge([](auto&&...) { return false; }) ? std::optional(Outline{}) : std::nullopt;
  }

  /// Sines of elevation, of a triangle or edge seen from the centre.
  struct Elevation {
    double low, high;

    Elevation(double lowest, double highest, double nearest, double farthest)
        : low(lowest / (lowest > 0 ? farthest : nearest)), high(highest / (highest > 0 ? nearest : farthest)) {}
  };

  Elevation elevation(const glm::dvec3& a, const glm::dvec3& b) const {
    return {std::min(a.z, b.z), std::max(a.z, b.z), glm::length(nearest_to_origin(a, b)),
            std::max(glm::length(a), glm::length(b))};
  }

  /// Of a triangle; from the centre, no point of it is nearer than its plane.
  Elevation elevation(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) const {
    const glm::dvec3 n = glm::cross(b - a, c - a);
    return {std::min({a.z, b.z, c.z}), std::max({a.z, b.z, c.z}), std::abs(glm::dot(n, a)) / glm::length(n),
            std::max({glm::length(a), glm::length(b), glm::length(c)})};
  }

  /// Of a sphere, seen from its centre; an end at a pole is none.
  std::optional<Outline> zone() const {
    const double low = candidate_.clip[0], high = candidate_.clip[1], middle = 0.5 * (low + high);
    double off = 0;
    Outline outline;
    each_edge([&](const glm::dvec3& a, const glm::dvec3& b) {
      const Elevation seen = elevation(a, b);
      const double end = low > -1 && (high >= 1 || a.z < middle) ? low : high;
      outline.vertices = std::max(outline.vertices, std::abs(a.z - end) / std::min(1., high - low));
      off = std::max({off, std::abs(seen.low - end), std::abs(seen.high - end)});
      return true;
    });
    for (const std::uint32_t t : region_.triangles) {
      const Elevation seen = elevation(map_.point(region_.corner(t, 0)), map_.point(region_.corner(t, 1)),
                                       map_.point(region_.corner(t, 2)));
      if (low > -1) off = std::max(off, low - seen.low);
      if (high < 1) off = std::max(off, seen.high - high);
    }
    const auto arc = [&](double end) {  // the longest that such a difference in height is
      const double at = std::asin(end);
      return std::max(std::asin(std::min(end + off, 1.)) - at, at - std::asin(std::max(end - off, -1.)));
    };
    if (!(off < 1)) return {};
    outline.distance =
        std::max(low > -1 ? arc(low) : 0, high < 1 ? arc(high) : 0) * std::max({lengths_.x, lengths_.y, lengths_.z});
    if (low > -1) outline.lower.z = low + off;
    if (high < 1) outline.upper.z = high - off;
    return outline;
  }

  std::optional<Outline> ends() const {
    const double low = candidate_.clip[0], high = candidate_.clip[1];
    const double middle = 0.5 * (low + high);
    double off = 0;
    const bool one_side_each = each_edge([&](const glm::dvec3& a, const glm::dvec3& b) {
      const double end = a.z < middle ? low : high;
      off = std::max({off, std::abs(a.z - end), std::abs(b.z - end)});
      return (a.z < middle) == (b.z < middle);
    });
    if (!one_side_each) return {};
    Outline outline;
    outline.vertices = off;
    each_corner([&](const glm::dvec3& p) { off = std::max({off, low - p.z, p.z - high}); });
    const Radius radius{candidate_.type};
    const double slope = std::max(std::abs(radius.slope(low - off)), std::abs(radius.slope(high + off)));
    outline.distance = off * std::hypot(lengths_.z, slope * std::max(lengths_.x, lengths_.y));
    outline.lower.z = low + off, outline.upper.z = high - off;
    return outline;
  }

  /// Of a cylinder: a rectangle where angle and height are seen as coordinates. Both are largest and smallest at an
  /// edge's ends.
  std::optional<Outline> sector() const {
    const double half = candidate_.half_angle, low = candidate_.clip[0], high = candidate_.clip[1];
    const double radius = std::max(lengths_.x, lengths_.y);
    const auto angle = [](const glm::dvec3& p) { return std::atan2(p.y, p.x); };
    double turn = 0, off = 0;
    each_edge([&](const glm::dvec3& a, const glm::dvec3& b) {
      const double beside = angle(a) * angle(b) < 0
                                ? infinity
                                : std::max(std::abs(std::abs(angle(a)) - half), std::abs(std::abs(angle(b)) - half));
      const double below = std::max(std::abs(a.z - low), std::abs(b.z - low));
      const double above = std::max(std::abs(a.z - high), std::abs(b.z - high));
      const double end = std::min(below, above);
      beside* radius < end* lengths_.z ? turn = std::max(turn, beside) : off = std::max(off, end);
      return true;
    });
    Outline outline;
    outline.vertices = std::max(turn, off);
    for (const std::uint32_t t : region_.triangles)
      for (int k = 0; k < 3; ++k) {
        const glm::dvec3 p = map_.point(region_.corner(t, k)), next = map_.point(region_.corner(t, (k + 1) % 3));
        if (std::abs(angle(p) - angle(next)) > std::numbers::pi) return {};  // right across what a sector leaves open
        turn = std::max(turn, std::abs(angle(p)) - half);
        off = std::max({off, low - p.z, p.z - high});
      }
    outline.distance = std::hypot(turn * radius, off * lengths_.z);
    outline.half_angle = half - turn;
    outline.lower.z = low + off, outline.upper.z = high - off;
    return outline;
  }

  std::optional<Outline> rim() const {
    const double rim = candidate_.type == QuadricType::disk ? 1 : section_radius(candidate_.type, candidate_.clip[1]);
    double off = 0;
    Outline outline;
    each_edge([&](const glm::dvec3& a, const glm::dvec3& b) {
      const glm::dvec3 from(a.x, a.y, 0), to(b.x, b.y, 0);
      off = std::max(off, rim - glm::length(nearest_to_origin(from, to)));
      outline.vertices = std::max(outline.vertices, std::abs(glm::length(from) - rim));
      return true;
    });
    each_corner([&](const glm::dvec3& p) { off = std::max(off, std::hypot(p.x, p.y) - rim); });
    const double slope = Height{candidate_.type}.steepest(rim + off, 0);
    outline.distance = off * std::hypot(std::max(lengths_.x, lengths_.y), slope * lengths_.z);
    outline.radius = rim - off;
    return outline;
  }

  std::optional<Outline> rectangle() const {
    const glm::dvec2 half = candidate_.half, size(lengths_);
    glm::dvec2 off(0);
    each_edge([&](const glm::dvec3& a, const glm::dvec3& b) {
      const glm::dvec2 from = glm::abs(glm::abs(glm::dvec2(a)) - half), to = glm::abs(glm::abs(glm::dvec2(b)) - half);
      // Both ends at one side, the one that they are nearest to.
      double x = std::max(from.x, to.x), y = std::max(from.y, to.y);
      if (a.x * b.x < 0) x = infinity;
      if (a.y * b.y < 0) y = infinity;
      x* size.x < y* size.y ? off.x = std::max(off.x, x) : off.y = std::max(off.y, y);
      return true;
    });
    Outline outline;
    outline.vertices = std::max(off.x / half.x, off.y / half.y);
    each_corner([&](const glm::dvec3& p) { off = glm::max(off, glm::abs(glm::dvec2(p)) - half); });
    const glm::dvec2 reach = half + off;
    const double slope = Height{candidate_.type}.steepest(reach.x, reach.y);
    const double across = glm::length(off * size), down = slope * glm::length(off) * lengths_.z;
    outline.distance = std::hypot(across, down);
    outline.lower = glm::dvec3(off - half, -infinity), outline.upper = glm::dvec3(half - off, infinity);
    return outline;
  }

  const Region& region_;
  const Candidate& candidate_;
  const WorldToObject& map_;
  glm::dvec3 lengths_;
};

}  // namespace

std::optional<Outline> compare_outline(const Region& region, const Candidate& candidate, const WorldToObject& map) {
  return Comparison(region, candidate, map).run();
}

}  // namespace rayengine::surfaces
