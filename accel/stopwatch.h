#pragma once

#include <chrono>
#include <ctime>

namespace rayengine {

/// Runs from when it is made; on the clock that never steps back.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// Seconds that the processor has worked for this program, summed over its cores.
inline double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace rayengine
