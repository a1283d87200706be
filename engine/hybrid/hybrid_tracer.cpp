#include "engine/hybrid/hybrid_tracer.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <thread>

#include "accel/stopwatch.h"
#include "engine/hybrid/ray_pool.h"
#include "engine/hybrid/report.h"
#include "engine/query.h"

namespace rayengine {
namespace {

constexpr std::size_t gpu_depth = 3;  // batches of the GPU: one copied, one traced, one written
constexpr std::size_t largest_gpu_batch = 262144;
constexpr std::size_t one_thread_rays = 4096;  // queries up to this are answered by their caller
constexpr double long_overdue = 1;             // seconds after which a GPU that does not answer is told of
constexpr double single_roundoff = 0x1p-24;

class HybridTracer : public Hybrid {
 public:
  HybridTracer(std::unique_ptr<Tracer> cpu, MakeTracer make_gpu, const HybridOptions& options);
  ~HybridTracer() override;

  std::string_view name() const override { return "hybrid"; }
  Precision precision() const override { return cpu_->precision(); }
  Limits limits() const override { return limits_; }
  double build_seconds() const override { return cpu_->build_seconds() + gpu_build_seconds_; }
  std::size_t bytes() const override { return cpu_->bytes() + gpu_bytes_; }

  void closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) override {
    check_lengths(rays.size(), hits.size());
    answer({false, ray_class}, rays, {hits, {}});
  }
  void any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) override {
    check_lengths(rays.size(), status.size());
    answer({true, ray_class}, rays, {{}, status});
  }
  HitLists all(std::span<const Ray> rays) override { return rayengine::all(*cpu_, rays); }

  HybridReport report() const override;
  void lose_gpu() override;

 private:
  void answer(WorkKind kind, std::span<const Ray> rays, const AnswerSpans& answers);
  void answer_alone(WorkKind kind, std::span<const Ray> rays, const AnswerSpans& answers);
  void answer_together(RayPool& pool, WorkKind kind, std::span<const Ray> rays, const AnswerSpans& answers);
  bool crew(RayPool& pool, const Job& job);
  void work(RayPool& pool, const CrewWork& work);
  std::size_t trace_own(const CrewWork& work);
  std::size_t trace_gpus(const CrewWork& work);
  void look_at_clock(const RayPool& pool);

  void start_feeders();
  void make_gpu();
  void feed();
  bool trace_on_gpu(Batch& batch);
  void fail(const std::string& why);
  void say_once(std::atomic<bool>& said, const std::string& text);

  const std::unique_ptr<Tracer> cpu_;
  const MakeTracer make_gpu_;
  const HybridOptions options_;
  const std::size_t threads_;
  Limits limits_;

  std::unique_ptr<Tracer> gpu_;
  std::unique_ptr<RayPool> own_pool_;
  std::atomic<RayPool*> pool_ = nullptr;  ///< once there is a GPU
  std::atomic<double> gpu_build_seconds_ = 0;
  std::atomic<std::size_t> gpu_bytes_ = 0;
  std::mutex gpu_door_;
  mutable std::mutex why_mutex_;
  std::string why_;  ///< there is no GPU

  std::atomic<bool> started_ = false, said_failed_ = false, said_overdue_ = false;
  std::atomic<double> alone_seconds_ = 0;
  std::atomic<std::uint64_t> alone_rays_ = 0;
  std::promise<void> made_;
  const std::shared_future<void> is_made_ = made_.get_future();
  std::vector<std::jthread> feeders_;  // last: they end before what they use
};

HybridTracer::HybridTracer(std::unique_ptr<Tracer> cpu, MakeTracer make_gpu, const HybridOptions& options)
    : cpu_(std::move(cpu)),
      make_gpu_(std::move(make_gpu)),
      options_(options),
      threads_(
          static_cast<std::size_t>(options.threads > 0 ? options.threads : tbb::this_task_arena::max_concurrency())),
      limits_(cpu_->limits()) {
  limits_.cuts = true;
  if (options_.patience == 0) {
    start_feeders();
    is_made_.wait();
    if (!pool_) return;
  }
  limits_.triangle_roundoff = std::max(limits_.triangle_roundoff, single_roundoff);
  limits_.quadric_roundoff = std::max(limits_.quadric_roundoff, single_roundoff);
}

HybridTracer::~HybridTracer() {
  if (started_) is_made_.wait();
  if (RayPool* pool = pool_) pool->close();
}

void HybridTracer::answer(WorkKind kind, std::span<const Ray> rays, const AnswerSpans& answers) {
  RayPool* pool = pool_.load(std::memory_order_acquire);
  if (pool && pool->gpu_in_use())
    answer_together(*pool, kind, rays, answers);
  else
    answer_alone(kind, rays, answers);
}

void HybridTracer::answer_alone(WorkKind kind, std::span<const Ray> rays, const AnswerSpans& answers) {
  const Stopwatch watch;
  const bool small = rays.size() <= one_thread_rays;
  if (small)
    trace(*cpu_, kind, rays, answers);
  else if (kind.any)
    rayengine::any(*cpu_, rays, answers.status, kind.ray_class);
  else
    rayengine::closest(*cpu_, rays, answers.hits, kind.ray_class);
  const double seconds = watch.seconds() * (small ? 1 : static_cast<double>(threads_));
  if (RayPool* pool = pool_) return pool->rested(kind, rays.size(), seconds);
  alone_rays_ += rays.size();
  const double spent = alone_seconds_ += seconds;
  if (spent > options_.patience * static_cast<double>(threads_) && !started_.exchange(true)) start_feeders();
}

void HybridTracer::answer_together(RayPool& pool, WorkKind kind, std::span<const Ray> rays,
                                   const AnswerSpans& answers) {
  const auto job = std::make_shared<Job>(kind, rays, answers);
  pool.enter(job);
  while (!job->done())
    if (!crew(pool, *job)) {
      pool.wait(*job);
      look_at_clock(pool);
    }
  pool.leave(*job);
  job->rethrow();
}

/// Whether there was anything to do.
bool HybridTracer::crew(RayPool& pool, const Job& job) {
  std::atomic<bool> any = false;
  const auto one = [&](std::size_t) {
    while (const auto work = pool.crew_work(job)) {
      this->work(pool, *work);
      any = true;
    }
  };
  if (job.rays.size() <= one_thread_rays) {
    one(0);
    return any;
  }
  // Even if the caller's own loop is cancelled meanwhile: what it asked for must be answered before it may go.
  tbb::task_group_context whatever_happens(tbb::task_group_context::isolated);
  tbb::parallel_for(std::size_t{0}, threads_, one, tbb::simple_partitioner(), whatever_happens);
  return any;
}

/// Rays that cannot be traced are failures of those who asked for them, not of the thread that happens to have them.
void HybridTracer::work(RayPool& pool, const CrewWork& work) {
  std::size_t answered = 0;
  try {
    answered = work.job ? trace_own(work) : trace_gpus(work);
  } catch (...) {
    work.job ? work.job->fail(work.rays, std::current_exception())
             : work.batch->fail(work.first, work.last, std::current_exception());
  }
  pool.crew_done(work, answered);
}

/// Returns the number of rays answered.
std::size_t HybridTracer::trace_own(const CrewWork& work) {
  trace(*cpu_, work.kind, work.job->rays.subspan(work.first, work.rays), work.job->answers.part(work.first, work.rays));
  work.job->answered.fetch_add(work.rays, std::memory_order_release);
  return work.rays;
}

/// The same for rays that the GPU has too.
std::size_t HybridTracer::trace_gpus(const CrewWork& work) {
  thread_local std::vector<Hit> hits;
  thread_local std::vector<std::uint32_t> status;
  work.kind.any ? status.resize(work.rays) : hits.resize(work.rays);
  AnswerSpans room;
  work.kind.any ? void(room.status = std::span(status).first(work.rays))
                : void(room.hits = std::span(hits).first(work.rays));
  trace(*cpu_, work.kind, work.batch->rays().subspan(work.batch->rays_before(work.first), work.rays), room);
  return work.batch->deliver(work.first, work.last, room);
}

void HybridTracer::look_at_clock(const RayPool& pool) {
  if (pool.overdue() > long_overdue)
    say_once(said_overdue_, "the GPU does not answer: the processor traces its rays as well");
}

void HybridTracer::start_feeders() {
  started_ = true;
  feeders_.emplace_back([this] {
    make_gpu();
    feed();
  });
  while (feeders_.size() < gpu_depth)
    feeders_.emplace_back([this] {
      is_made_.wait();
      feed();
    });
}

void HybridTracer::make_gpu() {
  try {
    gpu_ = make_gpu_();
    gpu_build_seconds_ = gpu_->build_seconds();
    gpu_bytes_ = gpu_->bytes();
    own_pool_ = std::make_unique<RayPool>(threads_, largest_gpu_batch, gpu_depth);
    pool_ = own_pool_.get();
  } catch (const std::exception& error) {
    const std::lock_guard lock(why_mutex_);
    why_ = "no GPU works here (" + std::string(error.what()) + "): the processor works alone";
    if (options_.say) options_.say(why_);
  }
  made_.set_value();
}

void HybridTracer::feed() {
  RayPool* pool = pool_;
  if (!pool) return;
  while (const auto batch = pool->gpu_work()) try {
      batch->stage();
      pool->staged(batch);
      if (!trace_on_gpu(*batch)) return;
      pool->landed(batch, batch->deliver(0, batch->blocks(), batch->room()));
    } catch (const std::exception& error) {
      fail(error.what());
    }
}

/// False when the GPU was lost meanwhile: then others have the batch.
bool HybridTracer::trace_on_gpu(Batch& batch) {
  std::unique_lock lock(gpu_door_, std::defer_lock);
  if (!gpu_->limits().concurrent) lock.lock();
  if (pool_.load()->gpu_lost()) return false;
  trace(*gpu_, batch.kind(), batch.rays(), batch.room());
  return true;
}

void HybridTracer::fail(const std::string& why) {
  pool_.load()->lose_gpu();
  say_once(said_failed_, "the GPU failed (" + why + "): the processor goes on alone");
}

void HybridTracer::say_once(std::atomic<bool>& said, const std::string& text) {
  if (!said.exchange(true) && options_.say) options_.say(text);
}

void HybridTracer::lose_gpu() {
  if (pool_) fail("lost on demand");
}

HybridReport HybridTracer::report() const {
  const RayPool* pool = pool_;
  if (pool) return report_on(*pool, threads_, alone_rays_);
  HybridReport report;
  report.cpu_rays = alone_rays_;
  const std::lock_guard lock(why_mutex_);
  report.why = why_.empty() ? "there was too little work to ask a GPU for" : why_;
  return report;
}

}  // namespace

std::unique_ptr<Hybrid> make_hybrid_tracer(std::unique_ptr<Tracer> cpu, const MakeTracer& make_gpu,
                                           const HybridOptions& options) {
  return std::make_unique<HybridTracer>(std::move(cpu), make_gpu, options);
}

}  // namespace rayengine
