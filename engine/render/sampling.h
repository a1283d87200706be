#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

namespace rayengine {

/// Where a pixel's samples lie. Their density is the reconstruction filter, so that their plain mean is the filtered
/// pixel, no sample is shared between pixels, and pixels can be worked out in any order (filter importance sampling:
/// Ernst, Stamminger, Greiner 2006). The filter is the 4-term Blackman-Harris window, three pixels wide.
class PixelSampler {
 public:
  explicit PixelSampler(int samples);

  /// Offset from the pixel's centre, in pixels, of sample s of pixel (x, y). A single sample is the centre itself.
  glm::dvec2 offset(int x, int y, int s) const;

 private:
  std::vector<glm::uvec2> points_;  ///< Sobol's first two dimensions as 32-bit fractions
};

/// The point of the filter's support, in [-1.5, 1.5] pixels, below which the share `u` in [0, 1) of its weight lies.
double filter_quantile(double u);

/// The filter's weight at distance x (in pixels, along one axis) from the pixel's centre; its integral is 1.
double filter_weight(double x);

}  // namespace rayengine
