#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "engine/measure/compare.h"
#include "engine/scene/scene.h"

namespace rayengine {

struct BenchOptions {
  std::vector<std::string> tracers;  ///< names of tracers and yardsticks (see contestant.h)
  std::vector<Precision> precisions;
  glm::ivec2 size{1024, 1024};  ///< of the primary rays; the other classes have at most as many
  int threads = 0;              ///< 0: as many as the machine has
  std::function<void(double share)> progress;
};

/// One tracer at one precision on one class of rays.
struct BenchRow {
  std::string tracer;
  Precision precision = Precision::robust;
  std::string ray_class;       ///< primary, shadow (any-hit queries), bounce, or random (chords of the scene)
  std::uint64_t rays = 0;      ///< in one timed run
  double mrays_per_s = 0;      ///< median of the runs
  double mrays_per_s_iqr = 0;  ///< upper less lower quartile
  double build_seconds = 0;
  std::size_t bytes = 0;
  Comparison errors;  ///< against `reference`, on a sample of the rays that were timed
};

/// Times every tracer at every precision on every class of rays, in turns, so that what the machine does meanwhile
/// strikes all of them alike. The answers that are checked are those of the last timed run; their buffers are poisoned
/// before every run. Combinations that cannot be made (a precision that a tracer does not hold, a yardstick that does
/// not know a quadric) are left out and named in `left_out`. Throws Error when nothing is left.
std::vector<BenchRow> bench(const Scene& scene, const BenchOptions& options, std::vector<std::string>& left_out);

}  // namespace rayengine
