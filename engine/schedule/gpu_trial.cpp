#include "engine/schedule/gpu_trial.h"

#include <algorithm>
#include <cmath>

namespace rayengine {
namespace {

constexpr double settling = 0.005;      // seconds after a change that are not measured
constexpr double alone_seconds = 0.01;  // after those, for the processor at least
constexpr double both_seconds = 0.025;  // for all at least
constexpr int understood = 2;           // landings after which the cost model tells latency from rate
constexpr int least_landings = 3;       // of the GPU meanwhile
constexpr double longest_wait = 1;      // seconds for the GPU's first answers
constexpr double least_gain = 1.1;      // of the rate of all over that of the processor: less is luck as soon
constexpr int trials_to_win = 2;
constexpr double next_trial = 50;  // in lengths of a trial: trials in vain cost 2 % at most
constexpr double next_proof = 4;   // the same for the first that was won; each later one comes twice as late
constexpr double latest_proof = 64;

}  // namespace

void GpuTrial::enter(Phase phase) {
  phase_ = phase;
  in_phase_ = 0;
  if (phase == Phase::alone) alone_ = before_ = {}, trial_ = 0;
  if (phase == Phase::after) before_ = alone_, alone_ = {};
  if (phase == Phase::both) crew_ = gpu_ = {}, landings_ = 0;
}

bool GpuTrial::measures_alone() const {
  return (phase_ == Phase::alone || phase_ == Phase::after) && in_phase_ > settling;
}

void GpuTrial::pass(double by_crew, double seconds) {
  if (measures_alone()) alone_.work += by_crew, alone_.seconds += seconds;
  if (phase_ == Phase::both || phase_ == Phase::on)
    crew_.work += by_crew, crew_.seconds += seconds, gpu_.seconds += seconds;
  in_phase_ += seconds;
  trial_ += seconds;
}

void GpuTrial::by_crew(double work, double seconds) {
  pass(work, seconds);
  switch (phase_) {
    case Phase::alone:
      if (alone_.seconds >= alone_seconds) enter(Phase::waiting);
      break;
    case Phase::waiting:
      if (in_phase_ >= longest_wait) crew_ = alone_, gpu_ = {}, decide();
      break;
    case Phase::both:
      if (in_phase_ >= longest_wait) enter(Phase::after);
      break;
    case Phase::after:
      if (alone_.seconds >= alone_seconds) decide();
      break;
    case Phase::on:
    case Phase::resting:
      if (in_phase_ >= rest_) enter(Phase::alone);
  }
}

void GpuTrial::by_gpu(double work, double seconds, double possible) {
  pass(0, seconds);
  if (phase_ == Phase::waiting) return enter(Phase::both);
  if (phase_ == Phase::after) in_phase_ = 0;  // only now is the processor alone
  if (phase_ != Phase::both && phase_ != Phase::on) return;
  gpu_.work += work, ++landings_;
  if (phase_ == Phase::both && landings_ >= understood && possible < (least_gain - 1) * alone_.rate()) return decide();
  if (phase_ == Phase::both && in_phase_ >= both_seconds && landings_ >= least_landings) enter(Phase::after);
}

void GpuTrial::decide() {
  // What else the machine does only takes away.
  last_ = {std::max(before_.rate(), alone_.rate()), crew_.rate(), gpu_.rate()};
  const bool won = rate_both() >= least_gain * last_.alone;
  won_ = won ? won_ + 1 : 0;
  if (won && won_ < trials_to_win && !pays_) return enter(Phase::alone);
  rest_ = won ? trial_ * std::min(latest_proof, next_proof * std::exp2(won_ - trials_to_win))
              : std::max(decided_ && !pays_ ? 2 * rest_ : 0, next_trial * trial_);
  pays_ = won;
  decided_ = true;
  enter(pays_ ? Phase::on : Phase::resting);
}

double GpuTrial::walk_share() const {
  return last_.gpu > 0 ? std::max(0.0, (last_.alone - last_.crew) / last_.gpu) : 0;
}

}  // namespace rayengine
