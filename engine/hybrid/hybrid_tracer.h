#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "accel/tracer.h"

namespace rayengine {

struct HybridOptions {
  int threads = 0;  ///< of the processor; 0: as many as the machine has
  /// The GPU's tracer is made beside the work when that has taken so many seconds; at once, and waited for, when 0.
  double patience = 0;
  /// Told, from any thread, in one line each: that there is no GPU, that it failed, or that it does not answer.
  std::function<void(const std::string&)> say;
};

/// What a hybrid measured of rays of one kind. Rates in rays a second, other times in seconds.
struct HybridClassReport {
  std::string kind;  ///< "primary", "shadow", "bounce", with "any" behind it for any-hit queries
  std::uint64_t cpu_rays = 0, gpu_rays = 0;
  double rate_alone = 0;   ///< of the processor without the GPU
  double gpu_latency = 0;  ///< of a batch
  double gpu_per_ray = 0;  ///< behind it
  double break_even = 0;   ///< rays from which on a batch pays
  double achieved = 0;     ///< of all, in the way that was chosen
  double bound = 0;        ///< the best that these figures allow (engine/schedule/split.h)
};

struct HybridReport {
  std::uint64_t cpu_rays = 0, gpu_rays = 0;
  std::uint64_t traced_twice = 0;  ///< rays of the GPU's that the processor traced too
  double scheduling_share = 0;     ///< of the processor's time for tracing
  bool decided = false;            ///< there was enough work to tell whether the GPU pays
  bool gpu_pays = false;
  double gain = 0;        ///< rate of all with the GPU over that of the processor alone
  double walk_share = 0;  ///< what a ray on the GPU cost the processor, over what tracing it costs
  std::string why;        ///< one sentence
  std::vector<HybridClassReport> classes;
};

/// One tracer on the processor and one on the GPU that answer the same rays together. See docs/scheduler.md.
class Hybrid : public Tracer {
 public:
  virtual HybridReport report() const = 0;
  /// As if the GPU had failed now: what it has is traced by the processor. For tests.
  virtual void lose_gpu() = 0;
};

using MakeTracer = std::function<std::unique_ptr<Tracer>()>;

/// `make_gpu` may throw Error: then the processor works alone. It is called on a thread of the hybrid's, and so must be
/// what it refers to as long as that lives. Answers are those of whichever tracer was first.
std::unique_ptr<Hybrid> make_hybrid_tracer(std::unique_ptr<Tracer> cpu, const MakeTracer& make_gpu,
                                           const HybridOptions& options = {});

}  // namespace rayengine
