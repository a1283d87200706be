#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace rayengine {

struct CarrRow {
  std::string row;  ///< how the rays were answered
  std::string scene;
  double rays_per_s = 0;  ///< median
};

struct CarrOptions {
  int threads = 0;  ///< 0: as many as the machine has
  int gpu = -1;     ///< an EGL device by its number; the best when negative
  std::function<void(double share)> progress;
};

/// The experiment of Carr, Hall and Hart, "The Ray Engine" (2002), section 6: the camera's rays (512x512) and one
/// bounce of each are answered by the processor alone, by the ray engine with synchronous read-back (one batch at a
/// time), by the same with asynchronous read-back (three), and by the processor's part of the ray engine with an
/// infinitely fast GPU: rays are walked to their treelets, and the tests answered from a recorded run. Rows take turns.
/// Throws Error without a GPU.
std::vector<CarrRow> carr(const Scene& scene, const std::string& name, const CarrOptions& options = {});

/// 8,000 balls strewn in a cube.
Scene many_balls();
/// A closed mesh of 200,000 triangles.
Scene large_mesh();

}  // namespace rayengine
