#pragma once

#include <vector>

#include "engine/plan/recognise/candidate.h"

namespace rayengine::surfaces {

/// A candidate that was proven.
struct Found {
  Candidate candidate;
  std::vector<std::uint32_t> triangles;
  double residual = 0;
};

/// Makes one capped quadric of a surface of revolution and the disks that close it, wherever those are its caps within
/// the tolerance.
void close_with_caps(std::vector<Found>& found, double tolerance);

}  // namespace rayengine::surfaces
