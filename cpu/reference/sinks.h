#pragma once

#include <algorithm>
#include <optional>

#include "cpu/reference/candidates.h"

namespace rayengine::reference {

/// The nearest hit, with the tie bit where another lies at exactly the same t.
class Closest final : public Sink {
 public:
  explicit Closest(const Ray& ray) : ray_(ray) {}

  void add(const Candidate& candidate) override {
    const int order = best_ ? compare_t(ray_, candidate, *best_) : -1;
    if (order <= 0) tied_ = order == 0;
    if (!best_ || before(ray_, candidate, *best_)) best_ = candidate;
  }
  double reach() const override { return best_ ? std::min(static_cast<double>(best_->at.t), ray_.tmax) : ray_.tmax; }

  const std::optional<Candidate>& best() const { return best_; }

  Hit hit() const {
    if (!best_) return {};
    Hit hit = describe(ray_, *best_);
    if (tied_) hit.status |= status_tie;
    return hit;
  }

 private:
  const Ray& ray_;
  std::optional<Candidate> best_;
  bool tied_ = false;
};

/// Whether there is any hit.
class Any final : public Sink {
 public:
  explicit Any(const Ray& ray) : tmax_(ray.tmax) {}

  void add(const Candidate&) override { found_ = true; }
  double reach() const override { return found_ ? -infinity : tmax_; }
  std::uint32_t status() const { return found_ ? status_hit : status_miss; }

 private:
  double tmax_;
  bool found_ = false;
};

/// Every hit that counts (see owns) in order, with the tie bit on those that have one t in common.
class All final : public Sink {
 public:
  All(const Ray& ray, const ClosedMeshes& closed) : ray_(ray), closed_(closed) {}

  void add(const Candidate& candidate) override {
    if (!owns(ray_, candidate, closed_)) return;
    const auto earlier = [&](const Candidate& a, const Candidate& b) { return before(ray_, a, b); };
    found_.insert(std::upper_bound(found_.begin(), found_.end(), candidate, earlier), candidate);
  }
  double reach() const override { return ray_.tmax; }

  std::vector<Hit> hits() const {
    std::vector<Hit> result;
    for (const Candidate& c : found_) result.push_back(describe(ray_, c));
    for (std::size_t i = 1; i < found_.size(); ++i)
      if (compare_t(ray_, found_[i - 1], found_[i]) == 0)
        result[i - 1].status |= status_tie, result[i].status |= status_tie;
    return result;
  }

 private:
  const Ray& ray_;
  const ClosedMeshes& closed_;
  std::vector<Candidate> found_;
};

}  // namespace rayengine::reference
