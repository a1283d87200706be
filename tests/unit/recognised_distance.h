#pragma once

#include "engine/plan/recognise/recognise.h"

// A witness to what recognise() promises: distances between samples, measured by other means than its own.
namespace rayengine::test {

struct Distances {
  double to_quadric = 0;   ///< the largest, from points on the triangles
  double to_mesh = 0;      ///< the largest, from points on the clipped quadric
  std::size_t points = 0;  ///< on the quadric
};

/// About `samples` points on either side.
Distances measured(const Mesh& mesh, const RecognisedQuadric& quadric, std::size_t samples);

}  // namespace rayengine::test
