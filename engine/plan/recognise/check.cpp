#include "engine/plan/recognise/check.h"

#include <glm/geometric.hpp>
#include <limits>

#include "engine/plan/recognise/nearest.h"
#include "engine/plan/recognise/outline.h"
#include "engine/plan/recognise/profile.h"

namespace rayengine::surfaces {
namespace {

/// Tessellations have their vertices on the surface. Where some are further off than this share of the tolerance, or of
/// how far the quadric bends, the surface is another one, or noisy.
constexpr double vertex_share = 0.25, vertex_noise = 1e-3;

/// What rounding may do to a sign in object space, where everything is about 1.
constexpr double sign_noise = 1e-12;

using Triangle = std::array<glm::dvec3, 3>;

glm::dvec3 normal(const Triangle& t) { return glm::cross(t[1] - t[0], t[2] - t[0]); }

template <class Function>
double smallest(const Triangle& t, Function f) {
  return std::min({f(t[0]), f(t[1]), f(t[2])});
}
template <class Function>
double largest(const Triangle& t, Function f) {
  return std::max({f(t[0]), f(t[1]), f(t[2])});
}

/// How far a triangle is from a quadric along its fibres: at most `most`, and at its corners `corners`.
struct Deviation {
  double most = 0, corners = 0;

  void add(double low, double high) { most = std::max({most, -low, high}); }
};

class Check {
 public:
  Check(const Region& region, const Candidate& candidate, double tolerance)
      : region_(region),
        candidate_(candidate),
        tolerance_(tolerance),
        map_(inverse(candidate.to_world)),
        fibres_(fibres_of(candidate.type, candidate.clip[0])),
        lengths_(lengths(candidate.to_world)) {}

  std::optional<double> run() {
    triangles_.reserve(region_.triangles.size());
    for (const std::uint32_t t : region_.triangles) {
      triangles_.push_back(corners(t));
      if (!faces_along(triangles_.back())) return {};
      measure(triangles_.back());
      if (!(along_fibres(deviation_.most) <= tolerance_)) return {};
    }
    if (!(along_fibres(deviation_.corners) <= vertex_share * tolerance_ && deviation_.corners <= vertex_noise))
      return {};
    const std::optional<Outline> outline = compare_outline(region_, candidate_, map_);
    if (!outline || outline->vertices > vertex_noise || !covered_once(*outline)) return {};
    const double residual = along_fibres(deviation_.most) + outline->distance + rounding();
    return residual <= tolerance_ ? std::optional(residual) : std::nullopt;
  }

 private:
  Triangle corners(std::uint32_t t) const {
    Triangle c;
    for (int k = 0; k < 3; ++k) c[k] = map_.point(region_.corner(t, k));
    if (candidate_.inward) std::swap(c[1], c[2]);
    return c;
  }

  double along_fibres(double d) const {
    switch (fibres_) {
      case Fibres::central: return d * std::max({lengths_.x, lengths_.y, lengths_.z});
      case Fibres::radial: return d * std::max(lengths_.x, lengths_.y);
      default: return d * lengths_.z;
    }
  }

  bool on_surface(double corners) const {
    const double turn = 1 - std::cos(candidate_.half_angle), rise = candidate_.clip[1] - candidate_.clip[0];
    const double bend = std::min(1., fibres_ == Fibres::central ? rise : turn);
    return along_fibres(corners) <= vertex_share * tolerance_ && corners <= vertex_noise * bend;
  }

  /// What the arithmetic here may be off, and whoever places the quadric.
  double rounding() const {
    const glm::dvec3& o = candidate_.to_world.origin;
    return 16 * std::numeric_limits<double>::epsilon() * (glm::length(o) + glm::length(lengths_));
  }

  glm::dvec3 along(const glm::dvec3& p) const { return fibre(candidate_.type, fibres_, p); }

  // A fibre's direction is linear in the point, and so is this product: it is smallest at a corner.
  bool faces_along(const Triangle& t) const {
    const glm::dvec3 n = normal(t);
    return smallest(t, [&](const glm::dvec3& p) { return glm::dot(n, along(p)); }) >= -sign_noise;
  }

  void measure(const Triangle& t) {
    switch (fibres_) {
      case Fibres::central:
        return measure_round(
            t, t, [](const glm::dvec3&) { return 1.; }, [](auto&) { return 1.; });
      case Fibres::radial: return measure_tube(t);
      default: return measure_dome(t);
    }
  }

  void measure_tube(const Triangle& t) {
    const Radius radius{candidate_.type};
    const double middle = (t[0].z + t[1].z + t[2].z) / 3, r = radius.at(middle), slope = radius.slope(middle);
    Triangle flat = t;
    for (glm::dvec3& p : flat) p.z = 0;
    measure_round(
        t, flat, [&](const glm::dvec3& p) { return radius.at(p.z); },
        [&](const glm::dvec3& p) { return r + slope * (p.z - middle); });
  }

  // Distance from the centre or axis, a convex function, less a convex radius. It is at most what it is at a corner
  // with the radius replaced by a tangent; it is at least what it is at a corner with the distance replaced by that
  // along any one direction, the best of which leads to the nearest point.
  template <class Size, class Tangent>
  void measure_round(const Triangle& t, const Triangle& across, Size size, Tangent tangent) {
    double high = -infinity;
    for (int k = 0; k < 3; ++k) {
      const double distance = glm::length(across[k]);
      high = std::max(high, distance - tangent(t[k]));
      deviation_.corners = std::max(deviation_.corners, std::abs(distance - size(t[k])));
    }
    const auto along = [&](const glm::dvec3& direction) {
      const double reach = glm::length(direction);
      if (!(reach > 0)) return -infinity;
      const glm::dvec3 unit = direction / reach;
      double low = infinity;
      for (int k = 0; k < 3; ++k) low = std::min(low, glm::dot(unit, across[k]) - size(t[k]));
      return low;
    };
    double low = along(normal(across));
    if (!(-low <= deviation_.most))
      for (int k = 0; k < 3; ++k) low = std::max(low, along(nearest_to_origin(across[k], across[(k + 1) % 3])));
    deviation_.add(low, high);
  }

  // Flat less convex plus convex: each convex function is replaced by a tangent where that keeps the bound.
  void measure_dome(const Triangle& t) {
    const Height height{candidate_.type};
    const glm::dvec3 m = (t[0] + t[1] + t[2]) / 3.;
    const double up = height.up(m), down = height.down(m);
    const glm::dvec3 up_slope = height.up_gradient(m), down_slope = height.down_gradient(m);
    const double low =
        smallest(t, [&](const glm::dvec3& p) { return p.z - height.up(p) + down + glm::dot(down_slope, p - m); });
    const double high =
        largest(t, [&](const glm::dvec3& p) { return p.z - up - glm::dot(up_slope, p - m) + height.down(p); });
    deviation_.add(low, high);
    deviation_.corners =
        std::max(deviation_.corners,
                 largest(t, [&](const glm::dvec3& p) { return std::abs(p.z - height.up(p) + height.down(p)); }));
  }

  /// Where the outline is compared: for spheres, at the distance 1.
  glm::dvec3 on_fibre(const glm::dvec3& p) const { return fibres_ == Fibres::central ? p / glm::length(p) : p; }

  /// Whether the fibre through the middle of the best triangle inside the outline meets no other.
  bool covered_once(const Outline& outline) const {
    const Triangle* best = nullptr;
    double most = sign_noise;
    for (const Triangle& t : triangles_) {
      const glm::dvec3 m = (t[0] + t[1] + t[2]) / 3.;
      const double seen = glm::dot(normal(t), along(m));
      if (seen > most && outline.contains(on_fibre(m))) best = &t, most = seen;
    }
    if (!best) return false;
    const glm::dvec3 m = ((*best)[0] + (*best)[1] + (*best)[2]) / 3., line = along(m);
    return std::ranges::count_if(triangles_, [&](const Triangle& t) { return meets(t, m, line); }) == 1;
  }

  /// Whether a line meets a triangle that faces along it, its edges included.
  static bool meets(const Triangle& t, const glm::dvec3& point, const glm::dvec3& along) {
    const glm::dvec3 a = t[0] - point, b = t[1] - point, c = t[2] - point;
    const auto side = [&](const glm::dvec3& p, const glm::dvec3& q) { return glm::dot(glm::cross(p, q), along); };
    return side(a, b) >= -sign_noise && side(b, c) >= -sign_noise && side(c, a) >= -sign_noise;
  }

  const Region& region_;
  const Candidate& candidate_;
  double tolerance_;
  WorldToObject map_;
  Fibres fibres_;
  glm::dvec3 lengths_;
  std::vector<Triangle> triangles_;  // in object space
  Deviation deviation_;
};

}  // namespace

std::optional<double> proven_residual(const Region& region, const Candidate& candidate, double tolerance) {
  if (!is_invertible(candidate.to_world)) return {};
  return Check(region, candidate, tolerance).run();
}

}  // namespace rayengine::surfaces
