#pragma once

#include <chrono>
#include <mutex>
#include <string>

namespace rayengine::cli {

/// A bar on stderr with the share done and the time left. It shows up when the work has taken a second, on a terminal
/// only, and goes when the object does.
class Progress {
 public:
  Progress(std::string label, bool wanted);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// From any thread; a share that is smaller than one seen before is passed over.
  void update(double share);

 private:
  using Clock = std::chrono::steady_clock;
  void draw(double share, double seconds);

  std::string label_;
  bool enabled_;
  bool drawn_ = false;
  double share_ = 0;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_ = start_ + std::chrono::seconds(1);
  std::mutex mutex_;
};

}  // namespace rayengine::cli
