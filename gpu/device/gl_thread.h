#pragma once

#include <condition_variable>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <queue>
#include <thread>
#include <type_traits>

namespace rayengine {

/// A thread that runs what it is given, in order: the only one that touches an OpenGL context, whoever asks.
class GlThread {
 public:
  GlThread() : thread_([this](std::stop_token stop) { serve(stop); }) {}

  /// Runs `work` there, waits for it, and returns or throws what it did.
  template <class Work>
  std::invoke_result_t<Work> run(Work&& work) {
    // Shared: the caller may be gone with the result while the thread is still on its way out of the task.
    const auto task = std::make_shared<std::packaged_task<std::invoke_result_t<Work>()>>(std::forward<Work>(work));
    auto result = task->get_future();
    {
      const std::lock_guard lock(mutex_);
      queue_.push([task] { (*task)(); });
    }
    ready_.notify_one();
    return result.get();
  }

 private:
  void serve(std::stop_token stop) {
    std::unique_lock lock(mutex_);
    while (ready_.wait(lock, stop, [this] { return !queue_.empty(); })) {
      const std::function<void()> work = std::move(queue_.front());
      queue_.pop();
      lock.unlock();
      work();
      lock.lock();
    }
  }

  std::mutex mutex_;
  std::condition_variable_any ready_;
  std::queue<std::function<void()>> queue_;
  std::jthread thread_;  // last: it ends before what it uses
};

}  // namespace rayengine
