#pragma once

#include <cmath>

namespace rayengine::surfaces {

/// The decimal number with the fewest digits that is within `allowance` of x: people design in round numbers, and files
/// and fits add noise.
inline double round_number(double x, double allowance) {
  if (!(allowance > 0) || !std::isfinite(x)) return x;
  for (int digits = static_cast<int>(std::floor(std::log10(allowance))) + 1;; --digits) {
    const double unit = std::pow(10., std::abs(digits));
    const double rounded = digits < 0 ? std::round(x * unit) / unit : std::round(x / unit) * unit;
    if (!std::isfinite(rounded)) return x;
    if (std::abs(rounded - x) <= allowance) return rounded;
  }
}

}  // namespace rayengine::surfaces
