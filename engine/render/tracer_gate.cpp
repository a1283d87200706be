#include "engine/render/tracer_gate.h"

#include <tbb/task_arena.h>

namespace rayengine {

template <class Query>
void TracerGate::pass(const Query& query) {
  const Clock::time_point arrived = Clock::now();
  std::unique_lock<std::mutex> lock(door_, std::defer_lock);
  if (!concurrent_) lock.lock();
  const Clock::time_point entered = Clock::now();
  // Isolated: a tracer that works in parallel itself must not pick up another tile on this thread while it waits.
  tbb::this_task_arena::isolate(query);
  waiting_ += entered - arrived;
  tracing_ += Clock::now() - entered;
}

void TracerGate::closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) {
  pass([&] { tracer_.closest(rays, hits, ray_class); });
}

void TracerGate::any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) {
  pass([&] { tracer_.any(rays, status, ray_class); });
}

}  // namespace rayengine
