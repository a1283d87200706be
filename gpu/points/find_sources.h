#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gpu/scene/kernel_program.h"
#include "gpu/scene/scene_textures.h"

namespace rayengine {

/// Sources of shaders, each of which needs those before it.
using Sources = std::vector<std::string_view>;

inline Sources operator+(Sources a, const Sources& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// find(): the hit of the ray of consider.glsl, in any stage; with grid_tests() among the defines.
inline const Sources grid_walk_sources{
    "accel/kernels/prelude.glsl",       "accel/kernels/box.glsl",          "accel/kernels/grid.glsl",
    "accel/kernels/triangle.glsl",      "accel/kernels/quadric.glsl",      "gpu/shaders/stream/ray.glsl",
    "gpu/shaders/stream/consider.glsl", "gpu/shaders/points/enough.glsl",  "gpu/shaders/grid/traverse.glsl",
    "gpu/shaders/stream/triangle.glsl", "gpu/shaders/stream/quadric.glsl", "gpu/shaders/grid/intersect.glsl",
    "gpu/shaders/points/grid.glsl"};

/// The same without a structure, for triangles alone.
inline const Sources naive_sources{"accel/kernels/prelude.glsl",       "accel/kernels/box.glsl",
                                   "accel/kernels/triangle.glsl",      "gpu/shaders/stream/ray.glsl",
                                   "gpu/shaders/stream/consider.glsl", "gpu/shaders/points/enough.glsl",
                                   "gpu/shaders/stream/triangle.glsl", "gpu/shaders/points/naive.glsl"};

}  // namespace rayengine
