#include "engine/hybrid/ray_pool.h"

#include <algorithm>
#include <utility>

namespace rayengine {
namespace {

constexpr auto glance = std::chrono::microseconds(200);  // between looks at what has become of others
constexpr double sending_guess = 0.5;                    // of what tracing costs the processor, while a GPU is unknown
constexpr std::size_t smallest_gpu_batch = 4096;
constexpr std::size_t smallest_crew_batch = 1024;
constexpr double fading = 1;  // seconds of a thread

/// Adds the seconds until it goes to a sum.
class AddSeconds {
 public:
  explicit AddSeconds(double& sum) : sum_(sum) {}
  ~AddSeconds() { sum_ += watch_.seconds(); }

 private:
  double& sum_;
  const Stopwatch watch_;
};

}  // namespace

RayPool::RayPool(std::size_t threads, std::size_t gpu_batch, std::size_t gpu_depth) {
  crew_.threads = std::max<std::size_t>(threads, 1);
  crew_.smallest = smallest_crew_batch;
  lane_.smallest = std::min(smallest_gpu_batch, gpu_batch);
  lane_.largest = gpu_batch;
  lane_.depth = gpu_depth;
}

double RayPool::now() const { return watch_.seconds(); }

/// Seconds since the last call in which there was work.
double RayPool::busy_since_last() {
  const double last = std::exchange(last_event_, now());
  return last_event_ - last;
}

/// Old figures fade: the machine may have other things to do by now.
void RayPool::count_alone(WorkKind kind, std::size_t rays, double seconds) {
  KindCounts& counts = counts_.kinds[kind.index()];
  if (counts.alone_seconds > fading) counts.alone_rays /= 2, counts.alone_seconds /= 2;
  counts.alone_rays += static_cast<double>(rays);
  counts.alone_seconds += seconds;
}

/// In the trial's unit.
double RayPool::work(WorkKind kind, std::size_t rays) const {
  const double alone = counts_.kinds[kind.index()].alone();
  return static_cast<double>(rays) * (alone > 0 ? alone : crew_models_[kind.index()].per_ray());
}

void RayPool::enter(std::shared_ptr<Job> job) {
  const Lock lock(mutex_);
  if (jobs_.empty()) last_event_ = now();
  jobs_.push_back(std::move(job));
  gpu_wakes_.notify_one();
}

void RayPool::leave(const Job& job) {
  const Lock lock(mutex_);
  std::erase_if(jobs_, [&](const auto& j) { return j.get() == &job; });
}

std::size_t RayPool::fresh() const {
  std::size_t rays = 0;
  for (const auto& job : jobs_) rays += job->fresh();
  return rays;
}

Situation RayPool::situation(WorkKind kind) {
  const double time = now();
  std::erase_if(busy_until_, [=](double end) { return end <= time; });
  crew_.owed = 0;
  for (const double end : busy_until_) crew_.owed += end - time;
  crew_.model = crew_models_[kind.index()];
  lane_.model = gpu_models_[kind.index()];
  // What sending costs is in the trial's verdict; until then it is guessed, so that little is risked.
  lane_.walk = lane_.model.known() ? 0 : sending_guess * crew_.model.per_ray();
  return {time, fresh(), crew_, {&lane_, 1}};
}

std::shared_ptr<Job> RayPool::job_with_rays(const Job* own) const {
  std::shared_ptr<Job> any;
  for (const auto& job : jobs_) {
    if (job->fresh() == 0) continue;
    if (job.get() == own) return job;
    if (!any) any = job;
  }
  return any;
}

CrewWork RayPool::begin(CrewWork work) {
  work.begun = now();
  work.due = work.begun + crew_models_[work.kind.index()].predict(work.rays);
  busy_until_.push_back(work.due);
  return work;
}

std::optional<CrewWork> RayPool::crew_work(const Job& own) {
  const Lock lock(mutex_);
  const AddSeconds watch(counts_.scheduling_seconds);
  if (auto work = from_orphans()) return work;
  if (auto work = from_job(own)) return work;
  return fresh() > 0 ? std::nullopt : from_gpu(own.kind);
}

/// Without a GPU there is nothing to weigh.
std::size_t RayPool::crew_rays(WorkKind kind) {
  return airborne_.empty() && !trial_.wants_gpu() ? crew_.largest : crew_batch(situation(kind));
}

std::optional<CrewWork> RayPool::from_job(const Job& own) {
  const std::shared_ptr<Job> job = job_with_rays(&own);
  if (!job) return {};
  const std::size_t rays = std::min(crew_rays(job->kind), job->fresh());
  if (rays == 0) return {};
  const std::size_t first = job->front;
  job->front += rays;
  return begin({.job = job, .first = first, .last = first + rays, .rays = rays, .kind = job->kind});
}

CrewWork RayPool::take_blocks(Airborne& from, std::size_t rays) {
  const std::size_t blocks = std::min((rays + Batch::block - 1) / Batch::block, from.open_blocks);
  const std::size_t last = from.open_blocks, first = last - blocks;
  from.open_blocks = first;
  const std::size_t taken = from.batch->rays_before(last) - from.batch->rays_before(first);
  return begin({.batch = from.batch, .first = first, .last = last, .rays = taken, .kind = from.batch->kind()});
}

std::optional<CrewWork> RayPool::from_orphans() {
  for (Airborne& orphan : orphans_)
    if (orphan.open_blocks > 0) return take_blocks(orphan, crew_.largest);
  orphans_.clear();
  return {};
}

std::optional<CrewWork> RayPool::from_gpu(WorkKind kind) {
  const auto again = crew_again(situation(kind));
  if (!again) return {};
  CrewWork work = take_blocks(airborne_[again->flight], again->rays);
  Flight& flight = lane_.flights[again->flight];
  flight.open = work.batch->rays_before(work.first);
  counts_.twice += work.rays;
  return work;
}

void RayPool::crew_done(const CrewWork& work, std::size_t answered) {
  const Lock lock(mutex_);
  const AddSeconds watch(counts_.scheduling_seconds);
  const double seconds = now() - work.begun;
  if (const auto end = std::ranges::find(busy_until_, work.due); end != busy_until_.end()) busy_until_.erase(end);
  crew_models_[work.kind.index()].add(work.rays, seconds);
  counts_.crew_seconds += seconds;
  counts_.kinds[work.kind.index()].by_crew += answered;
  if (airborne_.empty() && !trial_.wants_gpu()) count_alone(work.kind, work.rays, seconds);
  trial_.by_crew(this->work(work.kind, answered), busy_since_last());
  if (work.batch || work.job->done()) crew_wakes_.notify_all();  // it may have been another caller's last
  if (lane_.flights.size() < lane_.depth) gpu_wakes_.notify_one();
}

void RayPool::wait(const Job& job) {
  Lock lock(mutex_);
  if (!job.done()) crew_wakes_.wait_for(lock, glance);
}

std::shared_ptr<Job> RayPool::job_for_gpu() const { return trial_.wants_gpu() ? job_with_rays(nullptr) : nullptr; }

std::shared_ptr<Batch> RayPool::gpu_work() {
  Lock lock(mutex_);
  while (!closed_ && !lane_.lost) {
    if (const auto job = job_for_gpu()) {
      const AddSeconds watch(counts_.scheduling_seconds);
      if (const std::size_t rays = lane_batch(situation(job->kind), 0)) return make_batch(job->kind, rays);
    }
    gpu_wakes_.wait(lock);
  }
  return {};
}

/// Of all jobs of a kind, from the back, so that the processor's caches keep what is at the front.
std::shared_ptr<Batch> RayPool::make_batch(WorkKind kind, std::size_t rays) {
  auto batch = std::make_shared<Batch>(kind);
  for (const auto& job : jobs_) {
    const std::size_t count = std::min(rays - batch->size(), job->fresh());
    if (count == 0 || job->kind != kind) continue;
    job->back -= count;
    batch->add(job, job->back, count);
  }
  airborne_.push_back({batch, 0});
  lane_.flights.push_back({batch->size(), 0, now()});
  return batch;
}

void RayPool::staged(const std::shared_ptr<Batch>& batch) {
  const Lock lock(mutex_);
  const auto found = std::ranges::find(airborne_, batch, &Airborne::batch);
  if (found == airborne_.end()) {  // lost meanwhile
    orphans_.push_back({batch, batch->blocks()});
    return crew_wakes_.notify_all();
  }
  found->open_blocks = batch->blocks();
  lane_.flights[static_cast<std::size_t>(found - airborne_.begin())].open = batch->size();
}

void RayPool::landed(const std::shared_ptr<Batch>& batch, std::size_t answered) {
  const Lock lock(mutex_);
  const auto found = std::ranges::find(airborne_, batch, &Airborne::batch);
  if (found != airborne_.end()) {
    const auto at = found - airborne_.begin();
    lane_.model = gpu_models_[batch->kind().index()];
    learn(lane_, lane_.flights[static_cast<std::size_t>(at)], now());
    gpu_models_[batch->kind().index()] = lane_.model;
    lane_.flights.erase(lane_.flights.begin() + at);
    airborne_.erase(found);
  }
  counts_.kinds[batch->kind().index()].by_gpu += answered;
  const double possible =
      work(batch->kind(), lane_.largest) / gpu_models_[batch->kind().index()].predict(lane_.largest);
  trial_.by_gpu(work(batch->kind(), answered), busy_since_last(), possible);
  crew_wakes_.notify_all();
}

void RayPool::lose_gpu() {
  const Lock lock(mutex_);
  lane_.lost = true;
  // Batches that are being copied come later: see staged().
  for (const Airborne& a : airborne_)
    if (a.open_blocks > 0) orphans_.push_back(a);
  airborne_.clear();
  lane_.flights.clear();
  crew_wakes_.notify_all();
  gpu_wakes_.notify_all();
}

void RayPool::close() {
  const Lock lock(mutex_);
  closed_ = true;
  gpu_wakes_.notify_all();
}

bool RayPool::gpu_in_use() const {
  const Lock lock(mutex_);
  return !lane_.lost && !trial_.resting();
}

void RayPool::rested(WorkKind kind, std::size_t rays, double seconds) {
  const Lock lock(mutex_);
  counts_.kinds[kind.index()].by_crew += rays;
  counts_.crew_seconds += seconds;
  if (lane_.lost) return;
  count_alone(kind, rays, seconds);
  trial_.by_crew(work(kind, rays), seconds / static_cast<double>(crew_.threads));
}

bool RayPool::gpu_lost() const {
  const Lock lock(mutex_);
  return lane_.lost;
}

double RayPool::overdue() const {
  const Lock lock(mutex_);
  if (lane_.flights.empty() || !lane_.model.known()) return 0;
  return std::max(0.0, now() - forecast(lane_, 0).late);
}

PoolCounts RayPool::counts() const {
  const Lock lock(mutex_);
  return counts_;
}

GpuTrial RayPool::trial() const {
  const Lock lock(mutex_);
  return trial_;
}

CostModel RayPool::gpu_model(WorkKind kind) const {
  const Lock lock(mutex_);
  return gpu_models_[kind.index()];
}

}  // namespace rayengine
