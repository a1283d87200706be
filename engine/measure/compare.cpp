#include "engine/measure/compare.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/measure/bound.h"
#include "engine/measure/doubt.h"

namespace rayengine {
namespace {

constexpr std::size_t first_count = 16;                 // rays beyond bounds that are named
constexpr std::size_t block = 1024;                     // doubtful rays that are asked again together
constexpr double parts_of_bound[]{1, 0.125, 0.015625};  // small things lie within the bound

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

class Judge {
 public:
  Judge(Tracer& oracle, const Geometry& geometry, const Limits& limits, std::span<const Ray> rays, RayClass ray_class)
      : oracle_(oracle), geometry_(geometry), limits_(limits), rays_(rays), class_(ray_class) {}

  Comparison judge(std::span<const Hit> hits, std::span<const Hit> exact) {
    result_.rays = rays_.size();
    for (std::size_t i = 0; i < rays_.size(); ++i) look(i, hits[i], exact[i]);
    for (const double part : parts_of_bound) ask_again(part);
    for (const Doubt& doubt : doubts_) beyond_.push_back(doubt.index);
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
    doubts_.push_back({i, rays_[i], hit, exact, bound_of(geometry_, limits_, rays_[i], hit, exact)});
  }

  void look_at_t(std::size_t i, const Hit& hit, const Hit& exact) {
    const double difference = std::abs(hit.t - exact.t);
    record(difference, exact.t);
    if (hit.error > 0) {
      if (!(difference <= hit.error + exact.error)) beyond_.push_back(i);
      return;
    }
    const double bound = bound_of(geometry_, limits_, rays_[i], hit, exact);
    if (!(difference <= in_t(bound, rays_[i], exact) + exact.error))
      doubts_.push_back({i, rays_[i], hit, exact, bound});
  }

  void record(double difference, double t) {
    errors_.push_back(difference == 0 ? 0 : difference / std::abs(t));
    const std::size_t bin = ulp_bin(difference / float_ulp(t));
    if (result_.ulps.size() <= bin) result_.ulps.resize(bin + 1);
    ++result_.ulps[bin];
  }

  /// Asks the oracle about the neighbours of all rays in doubt, and keeps those that they do not explain.
  void ask_again(double part) {
    std::vector<Doubt> kept;
    for (std::size_t first = 0; first < doubts_.size(); first += block) {
      const auto some = std::span(doubts_).subspan(first, std::min(block, doubts_.size() - first));
      const std::vector<Hit> answers = ask_around(some, part);
      const std::size_t count = answers.size() / some.size();
      for (std::size_t k = 0; k < some.size(); ++k)
        if (explained(some[k], part, std::span(answers).subspan(k * count, count), geometry_, oracle_))
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
    oracle_.closest(rays, answers, class_);
    return answers;
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
