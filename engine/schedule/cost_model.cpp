#include "engine/schedule/cost_model.h"

#include <algorithm>
#include <cmath>

namespace rayengine {
namespace {

constexpr double memory = 0.8;          // weight of a batch over that of the next
constexpr double unknown_spread = 0.5;  // before anything was predicted
constexpr double least_spread = 0.02;
constexpr double least_per_ray = 1e-13;  // clocks do not tell less
constexpr double singular = 1e-9;

}  // namespace

void CostModel::add(std::size_t rays, double seconds, bool waited) {
  const double n = static_cast<double>(std::max<std::size_t>(rays, 1)), idle = waited ? 0 : 1;
  if (samples_ > 1) {
    const double expected = latency_ * idle + per_ray_ * n;
    const double off = std::clamp((seconds - expected) / std::max(expected, 1e-9), -2.0, 2.0);
    variance_ = memory * variance_ + off * off;
    variance_weight_ = memory * variance_weight_ + 1;
  }
  // A batch's weight is 1 / rays: its time is as uncertain as it is long.
  const auto mix = [](double& sum, double term) { sum = memory * sum + term; };
  mix(idle_, idle / n);
  mix(idle_rays_, idle);
  mix(rays_rays_, n);
  mix(idle_seconds_, idle * seconds / n);
  mix(rays_seconds_, seconds);
  ++samples_;
  fit();
}

double CostModel::spread() const {
  if (variance_weight_ == 0) return unknown_spread;
  // One batch says little: the doubt of before fades with the weight of what was seen.
  const double doubt = unknown_spread * unknown_spread;
  return std::max(least_spread, std::sqrt((variance_ + 0.1 * doubt) / (variance_weight_ + 0.1)));
}

void CostModel::fit() {
  const double determinant = idle_ * rays_rays_ - idle_rays_ * idle_rays_;
  if (determinant > singular * idle_ * rays_rays_)
    latency_ = std::max(0.0, (idle_seconds_ * rays_rays_ - rays_seconds_ * idle_rays_) / determinant);
  // What is too long for one size of batch is blamed on the rays until another size says otherwise.
  per_ray_ = (rays_seconds_ - latency_ * idle_rays_) / rays_rays_;
  if (per_ray_ < least_per_ray) {
    per_ray_ = least_per_ray;
    if (idle_ > 0) latency_ = std::max(0.0, (idle_seconds_ - per_ray_ * idle_rays_) / idle_);
  }
}

}  // namespace rayengine
