#pragma once

#include <cstddef>
#include <limits>

namespace rayengine {

/// Seconds.
inline constexpr double forever = std::numeric_limits<double>::infinity();

/// How long a device takes for a batch: seconds = latency + rays * per_ray, fitted to what was measured by least
/// squares in which old batches count less and less. A batch that waited behind another one hides its latency there, so
/// that it tells of the rate alone.
class CostModel {
 public:
  /// `seconds` from when the batch was handed over to when it was done; of a batch that `waited` for the one before it
  /// longer than the latency, from when that one was done.
  void add(std::size_t rays, double seconds, bool waited = false);

  bool known() const { return samples_ > 0; }
  /// Whether the latency is told from the rate, for which it takes two batches.
  bool settled() const { return samples_ > 1; }
  double latency() const { return latency_; }
  double per_ray() const { return per_ray_; }
  double predict(std::size_t rays) const { return latency_ + per_ray_ * static_cast<double>(rays); }
  /// Standard deviation of measured over predicted time.
  double spread() const;

 private:
  void fit();

  // Weighted sums for the normal equations: latency times `idle` plus per_ray times rays is seconds.
  double idle_ = 0, idle_rays_ = 0, rays_rays_ = 0, idle_seconds_ = 0, rays_seconds_ = 0;
  double latency_ = 0, per_ray_ = 0;
  double variance_ = 0, variance_weight_ = 0;
  std::size_t samples_ = 0;
};

}  // namespace rayengine
