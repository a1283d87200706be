#pragma once

#include <array>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "accel/stopwatch.h"
#include "engine/hybrid/batch.h"
#include "engine/schedule/gpu_trial.h"
#include "engine/schedule/policy.h"

namespace rayengine {

/// Work for a thread of the processor: rays of a job that are its own, or blocks of a batch that the GPU has too.
struct CrewWork {
  std::shared_ptr<Job> job;
  std::shared_ptr<Batch> batch;
  std::size_t first = 0, last = 0;  ///< rays of the job, or blocks of the batch
  std::size_t rays = 0;
  double begun = 0, due = 0;  ///< as predicted
  WorkKind kind;
};

/// What was measured of rays of one kind.
struct KindCounts {
  std::uint64_t by_crew = 0, by_gpu = 0;     ///< rays answered
  double alone_rays = 0, alone_seconds = 0;  ///< traced while no GPU was in use, and threads' time for it
  double alone() const { return alone_rays > 0 ? alone_seconds / alone_rays : 0; }  ///< of a thread, for a ray
};

/// Counts since the pool was made.
struct PoolCounts {
  std::array<KindCounts, WorkKind::count> kinds;
  std::uint64_t twice = 0;        ///< rays that both traced
  double scheduling_seconds = 0;  ///< spent in here, of all threads, waiting left out
  double crew_seconds = 0;        ///< spent tracing by threads of the processor
};

/// Everybody's rays, handed out by the policy (engine/schedule/policy.h). Thread-safe; it knows the clock, but neither
/// tracers nor threads.
class RayPool {
 public:
  RayPool(std::size_t threads, std::size_t gpu_batch, std::size_t gpu_depth);

  void enter(std::shared_ptr<Job> job);
  void leave(const Job& job);

  // The processor's side.
  /// Something for a thread to do, from its own job if there is; null when there is nothing to gain.
  std::optional<CrewWork> crew_work(const Job& own);
  /// To be called when it is done, with the number of rays that it answered.
  void crew_done(const CrewWork& work, std::size_t answered);
  /// Until the job is done, or there may be work again.
  void wait(const Job& job);

  // The GPU's side.
  /// A batch, as soon as the policy gives one; null once the pool is closed or the GPU is lost.
  std::shared_ptr<Batch> gpu_work();
  /// The batch is copied, and may be traced by others too.
  void staged(const std::shared_ptr<Batch>& batch);
  /// It came back, and `answered` of its rays had no answer before.
  void landed(const std::shared_ptr<Batch>& batch, std::size_t answered);
  /// The GPU is gone: nothing goes there any more, and what it has goes back.
  void lose_gpu();
  /// Its thread ends.
  void close();

  /// Whether queries should go through the pool: the GPU answers or is tried. Else `rested` is to be told of the
  /// seconds spent without it.
  bool gpu_in_use() const;
  void rested(WorkKind kind, std::size_t rays, double seconds);

  bool gpu_lost() const;
  /// Seconds by which the oldest batch is past what was expected; 0 when none is.
  double overdue() const;
  PoolCounts counts() const;
  GpuTrial trial() const;
  CostModel gpu_model(WorkKind kind) const;

 private:
  using Lock = std::unique_lock<std::mutex>;
  struct Airborne {
    std::shared_ptr<Batch> batch;
    std::size_t open_blocks = 0;  ///< the first so many are nobody else's yet
  };

  double now() const;
  double busy_since_last();
  void count_alone(WorkKind kind, std::size_t rays, double seconds);
  double work(WorkKind kind, std::size_t rays) const;
  Situation situation(WorkKind kind);
  std::size_t fresh() const;
  std::shared_ptr<Job> job_with_rays(const Job* own) const;
  std::shared_ptr<Job> job_for_gpu() const;
  CrewWork begin(CrewWork work);
  std::size_t crew_rays(WorkKind kind);
  std::optional<CrewWork> from_job(const Job& own);
  std::optional<CrewWork> from_orphans();
  std::optional<CrewWork> from_gpu(WorkKind kind);
  CrewWork take_blocks(Airborne& from, std::size_t rays);
  std::shared_ptr<Batch> make_batch(WorkKind kind, std::size_t rays);

  const Stopwatch watch_;
  mutable std::mutex mutex_;
  std::condition_variable crew_wakes_, gpu_wakes_;
  bool closed_ = false;
  std::deque<std::shared_ptr<Job>> jobs_;
  std::array<CostModel, WorkKind::count> crew_models_, gpu_models_;
  GpuTrial trial_;
  Crew crew_;
  Lane lane_;                       ///< its flights are those of `airborne_`
  std::vector<Airborne> airborne_;  ///< batches that the GPU has, oldest first
  std::vector<Airborne> orphans_;   ///< batches that a lost GPU had
  std::vector<double> busy_until_;  ///< threads of the processor, as predicted
  double last_event_ = 0;
  PoolCounts counts_;
};

}  // namespace rayengine
