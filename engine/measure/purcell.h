#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace rayengine {

/// What the rays of one state cost in one picture.
struct PurcellRow {
  unsigned resolution = 0;  ///< voxels along the longest axis
  std::string state;        ///< traverse, intersect or shade
  std::size_t passes = 0;
  double milliseconds = 0;  ///< in the fastest run: of the processor where the GPU is software, else elapsed
};

/// What a way of choosing the next kernel costs in one picture.
struct PurcellPolicyRow {
  std::string policy;
  std::size_t steps = 0;   ///< voxels that a ray crosses in one traverse pass, at most
  std::size_t passes = 0;  ///< of all states
  double milliseconds = 0;
};

struct PurcellFigures {
  std::vector<PurcellRow> rows;  ///< one voxel a pass, as in the paper
  std::vector<PurcellPolicyRow> policies;
  unsigned usual_resolution = 0;  ///< which the policies were measured at
  std::string device;
  bool software = false;  ///< it is the processor
};

struct PurcellOptions {
  int gpu = -1;  ///< an EGL device by its number; the best when negative
  glm::ivec2 size{256, 256};
  int runs = 3;
  std::function<void(double share)> progress;
};

/// The experiment of Purcell, Buck, Mark and Hanrahan, "Ray Tracing on Programmable Graphics Hardware" (2002): a
/// picture with shadows and one reflection by the kernels of the grid tracer; passes and time in each state against the
/// grid's resolution, and ways of choosing the next kernel. Throws Error without a GPU.
PurcellFigures purcell(const Scene& scene, const PurcellOptions& options = {});

}  // namespace rayengine
