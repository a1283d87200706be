#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "gpu/cones/glass_caster.h"

namespace rayengine {

struct SzecsiRow {
  std::size_t triangles = 0;
  int size = 0;  ///< of the picture, both ways
  GlassOptions::Method method = GlassOptions::Method::hierarchical;
  double frames_per_s = 0;
  int stride = 1;  ///< only every so many passes were made and timed: see GlassOptions
};

struct SzecsiResult {
  std::string device;
  bool software = false;  ///< seconds are then those of the processor, summed over its cores
  std::vector<SzecsiRow> rows;
};

struct SzecsiOptions {
  int gpu = -1;                                ///< an EGL device by its number; the best when negative
  std::function<void(double share)> progress;  ///< called now and then with the share done
};

/// The experiment of Szecsi, "The Hierarchical Ray Engine" (2006), section 7: pictures of glass that fills the view,
/// paths of five rays, by the plain ray engine and hierarchically. 256x256 from 10 to 10,000 triangles; 512x512 at some
/// of them. Methods take turns; frames a second are of the processor's time where the device is a renderer in software,
/// which has other work besides. Throws Error without a GPU.
SzecsiResult szecsi(const SzecsiOptions& options = {});

/// A cone opening image of the experiment's scene: for each of these generations, half angles by tile.
struct SzecsiCones {
  int generation = 1;
  glm::ivec2 tiles{0};
  std::vector<float> angles;  ///< see GlassCaster::openings
};
std::vector<SzecsiCones> szecsi_cones(int gpu = -1);

/// The scene: bulky bodies of glass, one to five of them, with so many triangles in all (of the numbers measured
/// exactly so many), the first seen from so near that it fills the view. Material 0 is the glass.
Scene glass_bodies(std::size_t triangles, int size);

}  // namespace rayengine
