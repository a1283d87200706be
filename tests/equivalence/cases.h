#pragma once

#include <memory>
#include <string>
#include <vector>

#include "accel/geometry.h"

namespace rayengine::test {

/// A small scene to hold tracers against the oracle on.
struct Case {
  std::string name;
  std::shared_ptr<const Geometry> geometry;
  // What single precision may do to 1,500 random rays where nothing is aimed at edges.
  std::size_t differences = 4;
  double t_error = 1e-3;
};

/// Every kind of primitive, capped and not, clipped and not, alone and mixed, instanced, and far from the origin.
std::vector<Case> all_cases();

}  // namespace rayengine::test
