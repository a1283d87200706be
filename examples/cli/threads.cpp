#include "examples/cli/threads.h"

#include <sched.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <semaphore>

#include "examples/cli/cli.h"

namespace rayengine::cli {
namespace {

constexpr auto patience = std::chrono::milliseconds(20);  // with threads that do not come

/// Where threads wait for each other, so that none comes twice.
struct Meeting {
  std::mutex door;
  std::vector<pid_t> ids;
  std::counting_semaphore<> arrived{0}, over{0};

  void come() {
    {
      const std::scoped_lock lock(door);
      ids.push_back(gettid());
    }
    arrived.release();
    static_cast<void>(over.try_acquire_for(patience));
  }
};

}  // namespace

StartedThreads::StartedThreads(int threads) {
  const int others = thread_count(threads) - 1;
  const auto meeting = std::make_shared<Meeting>();
  tbb::task_arena arena(others + 1);
  for (int i = 0; i < others; ++i) arena.enqueue([meeting] { meeting->come(); });
  const auto end = std::chrono::steady_clock::now() + patience;
  for (int i = 0; i < others; ++i)
    if (!meeting->arrived.try_acquire_until(end)) break;
  meeting->over.release(others);
  const std::scoped_lock lock(meeting->door);
  ids_ = meeting->ids;
}

void StartedThreads::make_way() const {
  cpu_set_t cores;
  if (sched_getaffinity(0, sizeof cores, &cores) != 0) return;  // there are more than the set has room for
  if (ids_.size() >= static_cast<std::size_t>(CPU_COUNT(&cores))) return;
  CPU_CLR(sched_getcpu(), &cores);
  for (const pid_t id : ids_) sched_setaffinity(id, sizeof cores, &cores);
}

}  // namespace rayengine::cli
