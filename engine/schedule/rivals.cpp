#include <algorithm>
#include <cmath>
#include <deque>

#include "engine/schedule/simulation.h"

namespace rayengine {
namespace {

constexpr std::size_t chunk = 4096;      // rays that a thread takes at once
constexpr std::size_t buffer = 65536;    // LuxCore's
constexpr std::size_t pending_each = 3;  // buffers for each device
constexpr int passes = 10, rows = 1080;  // of the picture that Cycles renders
constexpr double close_enough = 0.02;    // Cycles' tolerance of unlike times

/// All devices of a machine; the processor, whose threads share each portion, is the last.
class Devices {
 public:
  Devices(const MadeMachine& machine, std::uint64_t seed)
      : gpus_(machine.gpus),
        processor_(0, machine.per_ray / static_cast<double>(machine.threads), machine.noise, {}, seed) {
    for (const MadeGpu& gpu : gpus_) queues_.emplace_back(gpu, seed + queues_.size() + 1);
    threads_ = static_cast<double>(machine.threads), per_ray_ = machine.per_ray;
  }
  std::size_t count() const { return gpus_.size() + 1; }

  /// When device `i` is done with `rays` handed over at `now`, in batches as large as it takes. Sending them costs the
  /// processor `walk` seconds a ray.
  double done(std::size_t i, double now, std::size_t rays) {
    double end = now;
    const bool processor = i == gpus_.size();
    const std::size_t most = processor ? chunk : gpus_[i].largest;
    for (std::size_t first = 0; first < rays; first += most) {
      const std::size_t size = std::min(most, rays - first);
      end = processor ? processor_.done(now, size) : send(i, now, size);
    }
    return end;
  }

 private:
  double send(std::size_t i, double now, std::size_t rays) {
    const MadeGpu& gpu = gpus_[i];
    if (gpu.walk > 0)
      now = processor_.done(now, static_cast<std::size_t>(static_cast<double>(rays) * gpu.walk / per_ray_));
    const double end = queues_[i].done(now, rays);
    return end > gpu.breaks ? std::numeric_limits<double>::infinity() : end;
  }

  const std::vector<MadeGpu>& gpus_;
  std::vector<MadeQueue> queues_;
  MadeQueue processor_;
  double threads_, per_ray_;
};

/// Cycles' rule: every weight moves towards the one with which all would have taken the mean time.
void rebalance(std::vector<double>& weights, const std::vector<double>& times) {
  const double count = static_cast<double>(times.size());
  double mean = 0, sum = 0;
  for (const double t : times) mean += t / count;
  const auto target = [&](double t) { return t + (mean - t) / count; };
  if (std::ranges::all_of(times, [&](double t) { return std::abs(1 - target(t) / mean) < close_enough; })) return;
  for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] *= target(times[i]) / times[i];
  for (double& w : weights) w /= sum;
}

/// Rows of each device: at least one, and the last takes the rest.
std::vector<std::size_t> slices(const std::vector<double>& weights) {
  std::vector<std::size_t> result;
  int left = rows;
  for (std::size_t i = 0; i + 1 < weights.size(); ++i) {
    const int others = static_cast<int>(weights.size() - 1 - i);
    const int height = std::clamp(static_cast<int>(std::lround(rows * weights[i])), 1, left - others);
    result.push_back(static_cast<std::size_t>(height));
    left -= height;
  }
  result.push_back(static_cast<std::size_t>(left));
  return result;
}

}  // namespace

double simulate_even_split(const MadeMachine& machine, std::size_t rays, std::uint64_t seed) {
  Devices devices(machine, seed);
  double end = 0;
  for (std::size_t i = 0; i < devices.count(); ++i) end = std::max(end, devices.done(i, 0, rays / devices.count()));
  return end;
}

double simulate_cycles(const MadeMachine& machine, std::size_t rays, std::uint64_t seed) {
  Devices devices(machine, seed);
  std::vector<double> weights(devices.count(), 1.0 / static_cast<double>(devices.count()));
  double now = 0;
  for (int pass = 0; pass < passes; ++pass) {
    const std::vector<std::size_t> heights = slices(weights);
    std::vector<double> times;
    for (std::size_t i = 0; i < devices.count(); ++i)
      times.push_back(devices.done(i, now, rays * heights[i] / (passes * rows)) - now);
    now += *std::ranges::max_element(times);
    if (!std::isfinite(now)) return now;
    rebalance(weights, times);
  }
  return now;
}

double simulate_fewest_pending(const MadeMachine& machine, std::size_t rays, std::uint64_t seed) {
  Devices devices(machine, seed);
  std::vector<std::deque<double>> pending(devices.count());  // when each device's buffers are done
  std::deque<double> order;                                  // the same, of all in the order of handing out
  double now = 0, end = 0;
  for (std::size_t first = 0; first < rays; first += buffer) {
    if (order.size() == pending_each * devices.count()) {
      now = std::max(now, order.front());
      order.pop_front();
    }
    for (auto& times : pending)
      while (!times.empty() && times.front() <= now) times.pop_front();
    const auto fewest = std::ranges::min_element(pending, {}, [](const auto& times) { return times.size(); });
    const auto device = static_cast<std::size_t>(fewest - pending.begin());
    const double done = devices.done(device, now, std::min(buffer, rays - first));
    fewest->push_back(done);
    order.push_back(done);
    end = std::max(end, done);
  }
  return end;
}

}  // namespace rayengine
