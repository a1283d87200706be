#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/measure/compare.h"
#include "engine/measure/stress/case.h"

namespace rayengine {

struct StressOptions {
  std::vector<std::string> tracers;
  std::vector<Precision> precisions;
  std::vector<std::string> families;  ///< by name; empty: all
  std::uint64_t rays = 200'000;       ///< in all, of every tracer at every precision, some ten in a case at least
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: as many as the machine has
  int gpu = -1;     ///< an EGL device by its number; the best when negative
  /// Tracers with a precision that are known to abort the process on bad input: they are not asked.
  std::function<bool(const std::string& tracer, Precision precision)> aborts;
  std::function<void(double share)> progress;
};

/// One tracer at one precision on one case.
struct StressRow {
  int number = 0;  ///< of the family
  std::string family, variant;
  std::string tracer;
  Precision precision = Precision::robust;
  /// Against `reference`. Differences are looked into, and called ambiguous, at `robust` alone: `certified` has no
  /// excuse, and of `fast` and `half` nothing is asked.
  Comparison errors;
  double size = 1;  ///< of what is hit; errors of points are told in it
  bool aborted = false;
  std::string broken;  ///< the limit that is broken, in words; empty when none is

  std::uint64_t wrong() const { return errors.wrong(); }
};

struct StressReport {
  std::vector<StressRow> rows;
  std::vector<std::string> left_out;       ///< tracers and precisions that there are none of here, and why
  std::vector<std::string> refused;        ///< cases that a tracer refuses to hold, and why
  std::vector<std::string> oracle_errors;  ///< answers of `reference` that are not those worked out by hand

  /// Whether all limits hold, and the oracle is right.
  bool good() const;
};

/// Runs the stability suite. Throws Error when nothing can be run.
StressReport stress(const StressOptions& options);

}  // namespace rayengine
