#pragma once

#include <atomic>
#include <exception>
#include <span>

#include "accel/tracer.h"

namespace rayengine {

/// What is asked of rays, and what they have in common: rays of one kind cost alike.
struct WorkKind {
  bool any = false;  ///< asked whether, not where
  RayClass ray_class = RayClass::primary;

  static constexpr std::size_t count = 6;
  std::size_t index() const { return 2 * static_cast<std::size_t>(ray_class) + any; }
  bool operator==(const WorkKind&) const = default;
};

/// Room for answers: hits, or status when only that is asked.
struct AnswerSpans {
  std::span<Hit> hits;
  std::span<std::uint32_t> status;

  AnswerSpans part(std::size_t first, std::size_t count) const {
    return {hits.empty() ? hits : hits.subspan(first, count), status.empty() ? status : status.subspan(first, count)};
  }
};

/// Has a tracer answer them.
inline void trace(Tracer& tracer, WorkKind kind, std::span<const Ray> rays, const AnswerSpans& answers) {
  if (kind.any)
    tracer.any(rays, answers.status, kind.ray_class);
  else
    tracer.closest(rays, answers.hits, kind.ray_class);
}

/// One caller's query, as it lies in the pool. The caller waits until all is answered; until then, and no longer, its
/// memory may be touched.
struct Job {
  Job(WorkKind kind, std::span<const Ray> rays, const AnswerSpans& answers)
      : kind(kind), rays(rays), answers(answers), back(rays.size()) {}

  const WorkKind kind;
  const std::span<const Ray> rays;
  const AnswerSpans answers;
  std::size_t front = 0, back;            ///< rays between them are nobody's; the processor takes from the front
  std::atomic<std::size_t> answered = 0;  ///< or failed

  /// Instead of answers for `count` of its rays. The caller gets the first such error, once nobody has its rays.
  void fail(std::size_t count, const std::exception_ptr& error) {
    if (!failed_.exchange(true)) error_ = error;
    answered.fetch_add(count, std::memory_order_release);
  }
  /// Of a job that is done.
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

  std::size_t fresh() const { return back - front; }
  bool done() const { return answered.load(std::memory_order_acquire) == rays.size(); }

 private:
  std::atomic<bool> failed_ = false;
  std::exception_ptr error_;
};

}  // namespace rayengine
