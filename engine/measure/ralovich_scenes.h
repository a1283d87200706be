#pragma once

#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace rayengine {

struct NamedScene {
  std::string name;
  Scene scene;
};

/// Scenes of the sizes in the tables of Ralovich and Magdics (2010): an empty room of 12 triangles, a Cornell box of
/// 36, a figure in a closed box of 646 in place of their knight, and a knot of 1,012 in the Cornell box, 1,024
/// together. All rays of their cameras hit something. One light; every surface reflects a quarter.
std::vector<NamedScene> ralovich_scenes();
/// The last of them.
Scene cornell_knot();

/// A mesh in the same light: one, beside the camera, and every surface reflects a quarter. Throws Error when the scene
/// holds anything else.
Scene lit_as_ralovich(Scene scene);

}  // namespace rayengine
