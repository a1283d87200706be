#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/scene/pixels.h"

namespace rayengine {

/// Linear float pixels, rows from top to bottom, channels interleaved.
struct Image {
  int width = 0, height = 0;
  std::vector<std::string> channels;  ///< conventional EXR names: R G B A, Z, N.X, ...
  Pixels pixels;                      ///< width * height * channels.size()

  Image() = default;
  /// All zero.
  Image(int width, int height, std::vector<std::string> names)
      : width(width),
        height(height),
        channels(std::move(names)),
        pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * channels.size(), 0.f) {}

  float* pixel(int x, int y) { return pixels.data() + offset(x, y); }
  const float* pixel(int x, int y) const { return pixels.data() + offset(x, y); }

 private:
  std::size_t offset(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
           channels.size();
  }
};

}  // namespace rayengine
