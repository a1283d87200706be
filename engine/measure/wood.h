#pragma once

#include <functional>
#include <string>
#include <vector>

#include "accel/quadric.h"
#include "engine/scene/scene.h"

namespace rayengine {

/// Pictures a second of one method, whatever it keeps of the scene made anew for each.
struct WoodRow {
  std::string method;       ///< gpu, software, or embree
  double frames_per_s = 0;  ///< of the fastest: of the processor's seconds where the GPU is software, else elapsed
  double differing = 0;     ///< share of pixels that are off the picture of `software` by more than 0.02 in a channel
  Image picture;
};

/// One of the paper's quadrics in its unit form, as the GPU shows it.
struct WoodQuadric {
  QuadricType type;
  Image picture;
};

struct WoodFigures {
  std::vector<WoodRow> rows;
  std::vector<WoodQuadric> quadrics;
  std::uint32_t primitives = 0;
  std::string device;
  bool software = false;  ///< it is the processor
};

struct WoodOptions {
  int gpu = -1;   ///< an EGL device by its number; the best when negative
  int level = 4;  ///< of the sphereflake: (9^(level + 1) - 1) / 8 spheres, from 0 on
  glm::ivec2 size{256, 256};
  int runs = 3;
  std::function<void(double share)> progress;
};

/// The experiment of Wood, McCane and King, "Ray Tracing Arbitrary Objects on the GPU" (2004): pictures of a
/// sphereflake without shadows and reflections, by RayCaster (streams of 16-bit halves), by the same loop over all
/// objects on the processor, and by embree; and one of each of the paper's quadrics. Throws Error without a GPU.
WoodFigures wood(const WoodOptions& options = {});

}  // namespace rayengine
