#include "engine/measure/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "engine/measure/bound.h"

namespace rayengine {
namespace {

constexpr std::size_t first_count = 16;  // rays beyond bounds that are named
constexpr std::size_t block = 256;       // doubtful rays that are asked again together

/// What a tracer cannot have answered: found again where it wrote nothing.
Hit poison() {
  Hit hit;
  hit.t = hit.error = std::numeric_limits<double>::quiet_NaN();
  hit.status = status_hit;
  return hit;
}

bool has_nan(const Hit& h) {
  return std::isnan(h.t + h.error) || std::isnan(h.u + h.v) || std::isnan(h.normal.x + h.normal.y + h.normal.z);
}

bool same_ids(const Hit& a, const Hit& b) {
  return a.hit() == b.hit() && a.object == b.object && a.primitive == b.primitive;
}

double float_ulp(double t) { return std::ldexp(1.0, std::ilogb(t == 0 ? 0x1p-126 : t) - 23); }

/// 0, 1, 2, 3-4, 5-8, ...
std::size_t ulp_bin(double ulps) {
  return ulps < 0.5 ? 0 : 1 + static_cast<std::size_t>(std::ceil(std::log2(std::max(std::round(ulps), 1.0))));
}

/// How far the tracer's rounding can move this ray, for whichever of the two answers allows more.
double bound_of(const Geometry& geometry, const Limits& limits, const Ray& ray, const Hit& hit, const Hit& exact) {
  double bound = 0;
  for (const Hit* h : {&hit, &exact})
    if (h->hit() && std::isfinite(h->t)) bound = std::max(bound, rounding_bound(geometry, limits, ray, *h));
  return bound;
}

/// `bound` across the ray, as it shows in t on a plane surface with the exact hit's normal.
double in_t(double bound, const Ray& ray, const Hit& exact) {
  const double slope = std::abs(glm::dot(glm::dvec3(exact.normal), ray.direction));
  return slope > 0 ? bound / slope : infinity;
}

/// A ray whose answers differ, or whose t differ by more than a plane surface explains.
struct Doubt {
  std::size_t ray;
  double bound;  ///< how far rounding can move it where it hits
  double t;      ///< where that is
};

Ray with_interval(Ray ray, double widening) {
  ray.tmin -= widening;
  ray.tmax = std::max(ray.tmax + widening, ray.tmin);
  return ray;
}

/// Two unit vectors across `d`, which has unit length.
std::array<glm::dvec3, 2> across(const glm::dvec3& d) {
  const glm::dvec3 aside = std::abs(d.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(d, aside));
  return {right, glm::cross(right, d)};
}

/// What the tracer may have seen instead of the ray: its interval moved by the bound; the ray shifted across itself, or
/// turned about its origin, in eight directions, by the bound and by small parts of it, as small things lie within it.
std::vector<Ray> neighbours(const Ray& ray, const Doubt& doubt) {
  const double length = glm::length(ray.direction), step = doubt.bound / length;
  const auto [right, up] = across(ray.direction / length);
  std::vector<Ray> rays{with_interval(ray, step), with_interval(ray, -step)};
  for (const double part : {1.0, 0.125, 0.015625})
    for (int i = 0; i < 8; ++i) {
      const double angle = i * std::numbers::pi / 4;
      const glm::dvec3 move = part * doubt.bound * (std::cos(angle) * right + std::sin(angle) * up);
      Ray shifted = ray, turned = ray;
      shifted.origin += move;
      if (doubt.t > 0) turned.direction += move / doubt.t;
      rays.insert(rays.end(), {with_interval(shifted, step), with_interval(shifted, -step), turned});
    }
  return rays;
}

class Judge {
 public:
  Judge(Tracer& oracle, const Geometry& geometry, const Limits& limits, std::span<const Ray> rays, RayClass ray_class)
      : oracle_(oracle), geometry_(geometry), limits_(limits), rays_(rays), class_(ray_class) {}

  Comparison judge(std::span<const Hit> hits, std::span<const Hit> exact) {
    result_.rays = rays_.size();
    for (std::size_t i = 0; i < rays_.size(); ++i) look(i, hits[i], exact[i]);
    for (std::size_t i = 0; i < doubts_.size(); i += block)
      ask_again(std::span(doubts_).subspan(i, std::min(block, doubts_.size() - i)), hits, exact);
    std::sort(beyond_.begin(), beyond_.end());
    result_.beyond_bounds = beyond_.size();
    beyond_.resize(std::min(beyond_.size(), first_count));
    result_.first = beyond_;
    summarise();
    return result_;
  }

 private:
  void look(std::size_t i, const Hit& hit, const Hit& exact) {
    result_.hits += exact.hit();
    const bool nan = has_nan(hit);
    result_.nans += nan;
    const bool validity_differs = (hit.status ^ exact.status) & status_invalid;
    if (nan || validity_differs || !names_something(hit)) return beyond_.push_back(i);
    if (!same_ids(hit, exact)) return count_difference(i, hit, exact);
    if (hit.hit()) look_at_t(i, hit, exact);
  }

  /// Whether a hit's ids are those of a primitive at all.
  bool names_something(const Hit& hit) const {
    if (!hit.hit()) return true;
    if (hit.object >= geometry_.objects.size()) return false;
    const bool last = hit.object + 1 == geometry_.objects.size();
    const std::uint32_t end = last ? geometry_.primitive_count : geometry_.objects[hit.object + 1].first_primitive;
    return hit.primitive < end - geometry_.objects[hit.object].first_primitive;
  }

  void count_difference(std::size_t i, const Hit& hit, const Hit& exact) {
    ++(hit.hit() && exact.hit() ? result_.wrong_ids : hit.hit() ? result_.false_hits : result_.false_misses);
    doubt(i, hit, exact, bound_of(geometry_, limits_, rays_[i], hit, exact));
  }

  void doubt(std::size_t i, const Hit& hit, const Hit& exact, double bound) {
    doubts_.push_back({i, bound, std::min(hit.t, exact.t)});
  }

  void look_at_t(std::size_t i, const Hit& hit, const Hit& exact) {
    const double difference = std::abs(hit.t - exact.t);
    record(difference, exact.t);
    if (hit.error > 0) {
      if (!(difference <= hit.error + exact.error)) beyond_.push_back(i);
      return;
    }
    const double bound = bound_of(geometry_, limits_, rays_[i], hit, exact);
    if (!(difference <= in_t(bound, rays_[i], exact) + exact.error)) doubt(i, hit, exact, bound);
  }

  void record(double difference, double t) {
    errors_.push_back(difference == 0 ? 0 : difference / std::abs(t));
    const std::size_t bin = ulp_bin(difference / float_ulp(t));
    if (result_.ulps.size() <= bin) result_.ulps.resize(bin + 1);
    ++result_.ulps[bin];
  }

  void ask_again(std::span<const Doubt> doubts, std::span<const Hit> hits, std::span<const Hit> exact) {
    std::vector<Ray> rays;
    for (const Doubt& doubt : doubts) {
      const std::vector<Ray> some = neighbours(rays_[doubt.ray], doubt);
      rays.insert(rays.end(), some.begin(), some.end());
    }
    std::vector<Hit> answers(rays.size());
    oracle_.closest(rays, answers, class_);
    const std::size_t count = rays.size() / doubts.size();
    for (std::size_t k = 0; k < doubts.size(); ++k) {
      const std::size_t i = doubts[k].ray;
      decide(doubts[k], hits[i], exact[i], std::span(answers).subspan(k * count, count));
    }
  }

  void decide(const Doubt& doubt, const Hit& hit, const Hit& exact, std::span<const Hit> answers) {
    const bool differs = !same_ids(hit, exact);
    const bool explained =
        changes(exact, answers) || (differs ? as_near(doubt, hit, exact) : among(doubt, hit, exact, answers));
    if (!explained)
      beyond_.push_back(doubt.ray);
    else if (differs)
      ++result_.ambiguous;
  }

  static bool changes(const Hit& exact, std::span<const Hit> answers) {
    return std::any_of(answers.begin(), answers.end(), [&](const Hit& a) { return !same_ids(a, exact); });
  }

  double slack(const Doubt& doubt, const Hit& exact) const {
    return in_t(doubt.bound, rays_[doubt.ray], exact) + exact.error;
  }

  /// Two surfaces nearer to each other than rounding tells apart are as ambiguous as a ray that nearly misses one, if
  /// the ray meets both: the neighbour of a coplanar triangle is not.
  bool as_near(const Doubt& doubt, const Hit& hit, const Hit& exact) const {
    if (!hit.hit() || !exact.hit() || !(std::abs(hit.t - exact.t) <= slack(doubt, exact))) return false;
    const HitLists met = oracle_.all(rays_.subspan(doubt.ray, 1));
    return std::any_of(met.hits.begin(), met.hits.end(), [&](const Hit& h) { return same_ids(h, hit); });
  }

  /// Whether t lies among those that the moved rays got, which on a curved surface spread further than on a plane one.
  bool among(const Doubt& doubt, const Hit& hit, const Hit& exact, std::span<const Hit> answers) const {
    const auto [low, high] =
        std::minmax_element(answers.begin(), answers.end(), [](const Hit& a, const Hit& b) { return a.t < b.t; });
    return low->t - slack(doubt, exact) <= hit.t && hit.t <= high->t + slack(doubt, exact);
  }

  void summarise() {
    if (errors_.empty()) return;
    std::sort(errors_.begin(), errors_.end());
    result_.max_t_error = errors_.back();
    result_.p999_t_error = errors_[(errors_.size() - 1) * 999 / 1000];
  }

  Tracer& oracle_;
  const Geometry& geometry_;
  const Limits limits_;
  std::span<const Ray> rays_;
  const RayClass class_;
  Comparison result_;
  std::vector<Doubt> doubts_;
  std::vector<std::size_t> beyond_;
  std::vector<double> errors_;  // of t, relative
};

}  // namespace

Comparison compare(Tracer& tracer, Tracer& oracle, const Geometry& geometry, std::span<const Ray> rays,
                   RayClass ray_class) {
  std::vector<Hit> hits(rays.size(), poison()), exact(rays.size(), poison());
  tracer.closest(rays, hits, ray_class);
  oracle.closest(rays, exact, ray_class);
  return Judge(oracle, geometry, tracer.limits(), rays, ray_class).judge(hits, exact);
}

}  // namespace rayengine
