#pragma once

#include <sys/types.h>

#include <vector>

namespace rayengine::cli {

/// oneTBB's threads, started before there is work for them. In a virtual machine Linux may queue a thread that wakes up
/// behind the one that woke it, 2 to 10 ms long and though other cores idle, which small pictures feel.
class StartedThreads {
 public:
  /// All that work with `--threads threads`, but this one.
  explicit StartedThreads(int threads);

  /// Keeps them off the core that this thread is on; for when work is at hand. More threads than cores stay as they
  /// are.
  void make_way() const;

 private:
  std::vector<pid_t> ids_;
};

}  // namespace rayengine::cli
