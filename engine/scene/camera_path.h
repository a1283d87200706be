#pragma once

#include <span>
#include <vector>

#include "engine/scene/scene.h"

namespace rayengine {

/// Where a moving camera is at a time, in any unit.
struct CameraKey {
  double time = 0;
  Camera camera;
};

/// The cameras of `frames` pictures, at equal steps of time, along a smooth path through at least two keys whose times
/// rise: `from`, `at`, `up` and `fov` are cubics between keys, with a common velocity at each (that of the parabola
/// through it and its neighbours, as in the splines of Catmull and Rom). The first and last pictures are those of the
/// first and last key. A path that ends as it began is a loop: its motion goes on smoothly there, and the picture that
/// would be the first again is left out.
std::vector<Camera> camera_path(std::span<const CameraKey> keys, int frames);

}  // namespace rayengine
