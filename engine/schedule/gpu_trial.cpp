#include "engine/schedule/gpu_trial.h"

#include <algorithm>

namespace rayengine {
namespace {

constexpr double alone_seconds = 0.02;  // that the processor is measured for at least
constexpr double both_seconds = 0.05;   // that all are measured for at least
constexpr int least_landings = 3;       // of the GPU meanwhile
constexpr double longest_wait = 1;      // seconds for the GPU's first answer
constexpr double least_gain = 1.02;     // of the rate of all over that of the processor
constexpr double first_rest = 50;       // in lengths of the trial: a trial in vain costs 2 % at most

}  // namespace

void GpuTrial::enter(Phase phase) {
  phase_ = phase;
  in_phase_ = 0;
  if (phase == Phase::alone) alone_ = {}, trial_ = 0;
  if (phase == Phase::both) crew_ = gpu_ = {}, landings_ = 0;
}

void GpuTrial::pass(double seconds) {
  in_phase_ += seconds;
  if (phase_ == Phase::waiting || phase_ == Phase::both) trial_ += seconds;
  if (phase_ == Phase::alone) alone_.seconds += seconds;
  if (phase_ == Phase::both || phase_ == Phase::on) crew_.seconds += seconds, gpu_.seconds += seconds;
}

void GpuTrial::by_crew(std::size_t rays, double seconds) {
  pass(seconds);
  if (phase_ == Phase::alone) alone_.rays += static_cast<double>(rays);
  if (phase_ == Phase::both || phase_ == Phase::on) crew_.rays += static_cast<double>(rays);
  if (phase_ == Phase::alone && in_phase_ >= alone_seconds)
    enter(Phase::waiting);
  else if (phase_ == Phase::waiting && in_phase_ >= longest_wait)
    crew_ = alone_, gpu_ = {}, decide();
  else if (phase_ == Phase::both && in_phase_ >= std::max(both_seconds, longest_wait) && landings_ < least_landings)
    decide();
  else if (phase_ == Phase::resting && in_phase_ >= rest_)
    enter(Phase::alone);
}

void GpuTrial::by_gpu(std::size_t rays, double seconds) {
  pass(seconds);
  if (phase_ == Phase::waiting) return enter(Phase::both);
  if (phase_ == Phase::both || phase_ == Phase::on) gpu_.rays += static_cast<double>(rays), ++landings_;
  if (phase_ == Phase::both && in_phase_ >= both_seconds && landings_ >= least_landings) decide();
}

void GpuTrial::decide() {
  if (rate_both() >= least_gain * rate_alone()) return enter(Phase::on);
  rest_ = std::max(2 * rest_, first_rest * trial_);
  enter(Phase::resting);
}

double GpuTrial::walk_share() const {
  if (gpu_.rays == 0) return 0;
  return std::max(0.0, (rate_alone() - rate_crew()) / rate_gpu());
}

}  // namespace rayengine
