#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "accel/tracer.h"
#include "engine/plan/statistics.h"

namespace rayengine {

/// A ray whose answer is farther off than was promised.
struct BrokenPromise {
  Ray ray;
  Hit hit, exact;
};

struct Verification {
  std::uint64_t rays = 0, hits = 0;
  std::uint64_t beside = 0;  ///< rays that agree with a neighbour within the tolerance only: at edges and silhouettes
  double largest = 0;        ///< distance from the exact surface, in units of the tolerance, of all that agree
  std::uint64_t broken = 0;
  std::vector<BrokenPromise> examples;  ///< the first few
};

/// Asks a model's tracer and exact arithmetic the same rays, which must have directions of unit length.
///
/// The promise for a tolerance above 0: the object hit is that of the exact answer to this ray, or to one that passes
/// no farther than the tolerance beside it, and the point hit is no farther than the tolerance from that answer's
/// surface there. For a tolerance of 0: ids are the exact ones, and t is within the proven bounds.
Verification verify(const Scene& scene, const Scene& model, Tracer& tracer, const Tolerance& tolerance,
                    std::span<const Ray> rays);

/// Rays of the camera through points of the picture chosen at random.
std::vector<Ray> random_camera_rays(const Camera& camera, std::size_t count, std::uint64_t seed = 1);

}  // namespace rayengine
