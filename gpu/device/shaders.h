#pragma once

#include <span>
#include <string_view>

namespace rayengine {

struct EmbeddedText {
  std::string_view name;  ///< path from the root of the source tree, such as "accel/kernels/box.glsl"
  std::string_view text;
};

/// All shader sources, the intersection kernels among them; written by cmake/embed.cmake.
std::span<const EmbeddedText> embedded_shaders();

}  // namespace rayengine
