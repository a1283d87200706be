#pragma once

#include <chrono>
#include <mutex>
#include <span>

#include "accel/tracer.h"

namespace rayengine {

/// One thread's way to the tracer: measures the time spent in it, and lets one caller in at a time where the tracer
/// wants that.
class TracerGate {
 public:
  /// `door` is shared by the gates of all threads.
  TracerGate(Tracer& tracer, std::mutex& door)
      : tracer_(tracer), door_(door), concurrent_(tracer.limits().concurrent) {}

  void closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class);
  void any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class);

  double tracer_seconds() const { return tracing_.count(); }
  double waiting_seconds() const { return waiting_.count(); }

 private:
  using Clock = std::chrono::steady_clock;

  template <class Query>
  void pass(const Query& query);

  Tracer& tracer_;
  std::mutex& door_;
  bool concurrent_;
  std::chrono::duration<double> tracing_{0}, waiting_{0};
};

}  // namespace rayengine
