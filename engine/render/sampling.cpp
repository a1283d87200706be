#include "engine/render/sampling.h"

#include <cmath>
#include <numbers>

#include "engine/render/reversed_bits.h"

namespace rayengine {
namespace {

constexpr double radius = 1.5;
/// Harris, "On the use of windows for harmonic analysis", 1978: minimum 4-term window, as a series of cosines.
constexpr std::array<double, 4> window{0.35875, 0.48829, 0.14128, 0.01168};

/// The share of the filter's weight that lies below x.
double filter_share(double x) {
  double share = 0.5 + 0.5 * x / radius;
  for (int k = 1; k < 4; ++k) {
    const double frequency = k * std::numbers::pi / radius;
    share += window[k] / window[0] * std::sin(frequency * x) / (2 * radius * frequency);
  }
  return share;
}

double invert_share(double u) {
  double low = -radius, high = radius;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (filter_share(middle) < u ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

constexpr int quantile_steps = 1024;
using QuantileTable = std::array<double, quantile_steps + 1>;

QuantileTable make_quantiles() {
  QuantileTable table;
  for (int i = 0; i <= quantile_steps; ++i) table[i] = invert_share(static_cast<double>(i) / quantile_steps);
  return table;
}

/// Sobol's second dimension: its direction numbers are the rows of Pascal's triangle modulo 2.
std::uint32_t sobol_second(std::uint32_t index) {
  std::uint32_t result = 0;
  for (std::uint32_t v = 1u << 31; index; index >>= 1, v ^= v >> 1)
    if (index & 1u) result ^= v;
  return result;
}

/// Scatters the bits of a pixel's coordinates (the finaliser of SplitMix64).
std::uint64_t scattered(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

double fraction(std::uint32_t bits) { return std::ldexp(bits + 0.5, -32); }

}  // namespace

double filter_weight(double x) {
  if (std::abs(x) >= radius) return 0;
  double weight = 0;
  for (int k = 0; k < 4; ++k) weight += window[k] * std::cos(k * std::numbers::pi * x / radius);
  return weight / (2 * radius * window[0]);
}

double filter_quantile(double u) {
  static const QuantileTable table = make_quantiles();
  const double at = u * quantile_steps;
  const int i = static_cast<int>(at);
  return table[i] + (at - i) * (table[i + 1] - table[i]);
}

PixelSampler::PixelSampler(int samples) {
  if (samples == 1) return;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(samples); ++i)
    points_.emplace_back(reversed_bits(i), sobol_second(i));
}

glm::dvec2 PixelSampler::offset(int x, int y, int s) const {
  if (points_.empty()) return {0, 0};
  // One mask per pixel flips digits, which keeps the points' even spread and makes neighbours' errors unlike.
  const std::uint64_t mask =
      scattered((static_cast<std::uint64_t>(x) << 32 | static_cast<std::uint32_t>(y)) + 0x9E3779B97F4A7C15u);
  const glm::uvec2 point = points_[s] ^ glm::uvec2(mask >> 32, mask & 0xFFFFFFFFu);
  return {filter_quantile(fraction(point.x)), filter_quantile(fraction(point.y))};
}

}  // namespace rayengine
