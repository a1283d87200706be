#include "engine/measure/compare.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "engine/measure/bound.h"
#include "engine/measure/doubt.h"

namespace rayengine {
namespace {

constexpr std::size_t first_count = 16;                 // rays beyond bounds that are named
constexpr std::size_t asked_together = 1024;            // doubtful rays
constexpr double parts_of_bound[]{1, 0.125, 0.015625};  // small things lie within the bound

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

/// The angle between two unit vectors; their cosine would not tell small ones.
double angle(const glm::vec3& a, const glm::vec3& b) {
  return 2 * std::asin(std::min(0.5 * glm::length(glm::dvec3(a) - glm::dvec3(b)), 1.0));
}

/// Sorts the errors.
void summarise(std::vector<double>& errors, double& max, double& p999) {
  if (errors.empty()) return;
  std::sort(errors.begin(), errors.end());
  max = errors.back();
  p999 = errors[(errors.size() - 1) * 999 / 1000];
}

class Judge {
 public:
  Judge(const Answers& answers, Tracer* oracle)
      : oracle_(oracle),
        geometry_(answers.geometry),
        limits_(answers.limits),
        rays_(answers.rays),
        class_(answers.ray_class) {}

  Comparison judge(std::span<const Hit> hits, std::span<const Hit> exact) {
    result_.rays = rays_.size();
    for (std::size_t i = 0; i < rays_.size(); ++i) look(i, hits[i], exact[i]);
    for (const double part : parts_of_bound)
      if (oracle_) ask_again(part);
    for (const Doubt& doubt : doubts_) beyond_.push_back(doubt.index);
    std::sort(beyond_.begin(), beyond_.end());
    result_.beyond_bounds = beyond_.size();
    beyond_.resize(std::min(beyond_.size(), first_count));
    result_.first = beyond_;
    summarise(t_errors_, result_.max_t_error, result_.p999_t_error);
    if (!t_errors_.empty()) result_.median_t_error = t_errors_[t_errors_.size() / 2];
    summarise(point_errors_, result_.max_point_error, result_.p999_point_error);
    summarise(normal_errors_, result_.max_normal_error, result_.p999_normal_error);
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
    return hit.primitive < primitive_count(geometry_, hit.object);
  }

  void count_difference(std::size_t i, const Hit& hit, const Hit& exact) {
    ++(hit.hit() && exact.hit() ? result_.wrong_ids : hit.hit() ? result_.false_hits : result_.false_misses);
    doubts_.push_back({i, rays_[i], hit, exact, bound_of(geometry_, limits_, rays_[i], hit, exact)});
  }

  void look_at_t(std::size_t i, const Hit& hit, const Hit& exact) {
    const double difference = std::abs(hit.t - exact.t);
    record(difference, exact.t);
    point_errors_.push_back(difference * glm::length(rays_[i].direction));
    normal_errors_.push_back(angle(hit.normal, exact.normal));
    if (hit.error > 0) {
      if (difference <= hit.error + exact.error) return;
      ++result_.bound_violations;
      return beyond_.push_back(i);
    }
    if (!oracle_) return;
    const double bound = bound_of(geometry_, limits_, rays_[i], hit, exact);
    if (!(difference <= in_t(bound, rays_[i], exact) + exact.error))
      doubts_.push_back({i, rays_[i], hit, exact, bound});
  }

  void record(double difference, double t) {
    t_errors_.push_back(difference == 0 ? 0 : difference / std::abs(t));
    const std::size_t bin = ulp_bin(difference / float_ulp(t));
    if (result_.ulps.size() <= bin) result_.ulps.resize(bin + 1);
    ++result_.ulps[bin];
  }

  /// Asks the oracle about the neighbours of all rays in doubt, and keeps those that they do not explain.
  void ask_again(double part) {
    std::vector<Doubt> kept;
    for (std::size_t first = 0; first < doubts_.size(); first += asked_together) {
      const auto some = std::span(doubts_).subspan(first, std::min(asked_together, doubts_.size() - first));
      const std::vector<Hit> answers = ask_around(some, part);
      const std::size_t count = answers.size() / some.size();
      for (std::size_t k = 0; k < some.size(); ++k)
        if (explained(some[k], part, std::span(answers).subspan(k * count, count), geometry_, *oracle_))
          result_.ambiguous += !same_ids(some[k].hit, some[k].exact);
        else
          kept.push_back(some[k]);
    }
    doubts_ = std::move(kept);
  }

  std::vector<Hit> ask_around(std::span<const Doubt> doubts, double part) {
    std::vector<Ray> rays;
    for (const Doubt& doubt : doubts) {
      const std::vector<Ray> some = neighbours(doubt, part);
      rays.insert(rays.end(), some.begin(), some.end());
    }
    std::vector<Hit> answers(rays.size());
    oracle_->closest(rays, answers, class_);
    return answers;
  }

  Tracer* oracle_;  // null: nothing is asked again
  const Geometry& geometry_;
  const Limits limits_;
  std::span<const Ray> rays_;
  const RayClass class_;
  Comparison result_;
  std::vector<Doubt> doubts_;
  std::vector<std::size_t> beyond_;
  std::vector<double> t_errors_, point_errors_, normal_errors_;
};

}  // namespace

Hit unanswered() {
  Hit hit;
  hit.t = hit.error = std::numeric_limits<double>::quiet_NaN();
  hit.status = status_hit;
  return hit;
}

Comparison judge(const Answers& answers, Tracer* oracle) {
  return Judge(answers, oracle).judge(answers.hits, answers.exact);
}

Comparison compare(Tracer& tracer, Tracer& oracle, const Geometry& geometry, std::span<const Ray> rays,
                   RayClass ray_class) {
  std::vector<Hit> hits(rays.size(), unanswered()), exact(rays.size(), unanswered());
  tracer.closest(rays, hits, ray_class);
  oracle.closest(rays, exact, ray_class);
  return judge({geometry, tracer.limits(), rays, ray_class, hits, exact}, &oracle);
}

}  // namespace rayengine
