#include "engine/schedule/made_machine.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rayengine {
namespace {

/// Log-normal with mean 1.
double noisy(Random& random, double deviation) {
  if (deviation == 0) return 1;
  const double radius = std::sqrt(-2 * std::log(1 - random.unit()));
  const double normal = radius * std::cos(2 * std::numbers::pi * random.unit());
  return std::exp(deviation * normal - deviation * deviation / 2);
}

/// Work done from 0 to `end` at the speeds given.
double work(const std::vector<SpeedChange>& speed, double end) {
  double done = 0, from = 0, factor = 1;
  for (const SpeedChange& change : speed) {
    const double until = std::min(end, change.from);
    done += factor * std::max(0.0, until - from);
    from = change.from, factor = change.factor;
  }
  return done + factor * std::max(0.0, end - from);
}

/// When `amount` of work that begins at `start` is done.
double finish(const std::vector<SpeedChange>& speed, double start, double amount) {
  double from = start, factor = 1;
  for (const SpeedChange& change : speed) {
    if (change.from > from) {
      const double possible = factor * (change.from - from);
      if (possible >= amount) return from + amount / factor;
      amount -= possible;
      from = change.from;
    }
    factor = change.factor;
  }
  return factor > 0 ? from + amount / factor : forever;
}

/// Rays that one place for a batch can pass through within `seconds`.
double through_one_place(const MadeGpu& gpu, double seconds) {
  const double largest = static_cast<double>(gpu.largest), full = gpu.latency + gpu.per_ray * largest;
  const double batches = std::floor(seconds / full);
  return std::max(batches * largest, (seconds - (batches + 1) * gpu.latency) / gpu.per_ray);
}

double most_rays(const MadeGpu& gpu, double seconds) {
  const double end = std::min(seconds, gpu.breaks);
  const double at_rate = std::min(end - gpu.latency, work(gpu.speed, end)) / gpu.per_ray;
  return std::max(0.0, std::min(at_rate, static_cast<double>(gpu.depth) * through_one_place(gpu, end)));
}

double most_rays(const MadeMachine& machine, double seconds) {
  double processor = seconds * static_cast<double>(machine.threads), rays = 0;
  for (const MadeGpu& gpu : machine.gpus) {
    if (gpu.walk >= machine.per_ray) continue;
    const double sending = std::min(processor, (seconds - gpu.latency) * static_cast<double>(machine.threads));
    const double sent = std::min(most_rays(gpu, seconds), gpu.walk > 0 ? std::max(0.0, sending) / gpu.walk : forever);
    processor -= sent * gpu.walk;
    rays += sent;
  }
  return rays + processor / machine.per_ray;
}

}  // namespace

MadeQueue::MadeQueue(double latency, double per_ray, double noise, std::vector<SpeedChange> speed, std::uint64_t seed)
    : latency_(latency), per_ray_(per_ray), noise_(noise), speed_(std::move(speed)), random_(seed, 1) {}

double MadeQueue::done(double now, std::size_t rays) {
  const double start = std::max(now + latency_ / 2, free_);
  free_ = finish(speed_, start, alone(rays));
  return free_ + latency_ / 2;
}

double MadeQueue::alone(std::size_t rays) { return static_cast<double>(rays) * per_ray_ * noisy(random_, noise_); }

double oracle_bound(const MadeMachine& machine, std::size_t rays) {
  double low = 0, high = static_cast<double>(rays) * machine.per_ray / static_cast<double>(machine.threads);
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (most_rays(machine, middle) < static_cast<double>(rays) ? low : high) = middle;
  }
  return high;
}

}  // namespace rayengine
