#include "engine/schedule/simulation.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <queue>
#include <set>

#include "engine/schedule/policy.h"

namespace rayengine {
namespace {

constexpr double call_overhead = 1e-6;  // seconds of the processor to take a range

/// The pool, the clock, and what happens when.
class Simulation {
 public:
  Simulation(const MadeMachine& machine, std::size_t rays, std::uint64_t seed);
  Outcome run();

 private:
  struct Event {
    double time;
    std::function<void()> happen;
    bool operator<(const Event& other) const { return time > other.time; }
  };
  /// Rays that were taken from another flight, to be traced as well.
  struct Borrowed {
    std::size_t lane;
    std::uint64_t id;
    std::size_t rays;
  };
  /// Of a flight, what the policy does not need to know.
  struct Ticket {
    std::uint64_t id;
    std::size_t unanswered;
    std::optional<Borrowed> borrowed = {};
  };
  struct Gpu {
    MadeQueue queue;
    double breaks, walk;
    std::vector<Ticket> tickets;          ///< as the lane's flights
    std::size_t to_send = 0, unsent = 0;  ///< rays of the newest flight that are not sent, and those that nobody sends
  };

  Situation situation();
  void at(double time, std::function<void()> happen) { events_.push({time, std::move(happen)}); }

  void hand_out();
  bool feed(std::size_t lane);
  bool send(std::size_t lane);
  void submit(std::size_t lane);
  void land(std::size_t lane, std::uint64_t id, bool failed);
  bool trace();
  bool trace_again();
  Borrowed borrow(const Again& again);
  void answer(const Borrowed& borrowed);
  void give_back(const Borrowed& borrowed);
  void take_off(std::size_t lane, std::size_t rays, std::optional<Borrowed> borrowed);
  void occupy_thread(std::size_t rays, const std::function<void()>& done);
  void wake_idle_threads();
  void answer(std::size_t rays) { answered_ += rays; }
  std::size_t place(std::size_t lane, std::uint64_t id) const;

  const std::size_t rays_;
  MadeQueue processor_;  ///< one thread's noise
  Crew crew_;
  std::vector<double> busy_until_;  ///< as predicted, of the threads that trace
  std::vector<Lane> lanes_;
  std::vector<Gpu> gpus_;
  std::size_t free_threads_, remaining_, answered_ = 0, by_gpu_ = 0, twice_ = 0;
  std::uint64_t next_id_ = 0;
  std::set<std::uint64_t> failed_;
  double now_ = 0, next_wake_ = 0;
  std::priority_queue<Event> events_;
};

Simulation::Simulation(const MadeMachine& machine, std::size_t rays, std::uint64_t seed)
    : rays_(rays),
      processor_(0, machine.per_ray, machine.noise, {}, seed),
      free_threads_(machine.threads),
      remaining_(rays) {
  crew_.threads = machine.threads;
  for (const MadeGpu& gpu : machine.gpus) {
    Lane lane;
    lane.walk = gpu.walk;
    lane.largest = gpu.largest;
    lane.depth = gpu.depth;
    lanes_.push_back(lane);
    gpus_.push_back({MadeQueue(gpu, seed + gpus_.size() + 1), gpu.breaks, gpu.walk, {}});
  }
}

Outcome Simulation::run() {
  hand_out();
  while (answered_ < rays_) {
    now_ = events_.top().time;
    const auto happen = events_.top().happen;
    events_.pop();
    happen();
    if (answered_ < rays_) hand_out();
  }
  const double rays = static_cast<double>(rays_);
  return {now_, static_cast<double>(by_gpu_) / rays, static_cast<double>(twice_) / rays};
}

Situation Simulation::situation() {
  std::erase_if(busy_until_, [this](double end) { return end <= now_; });
  crew_.owed = 0;
  for (const double end : busy_until_) crew_.owed += end - now_;
  return {now_, remaining_, crew_, lanes_};
}

void Simulation::hand_out() {
  for (std::size_t lane = 0; lane < lanes_.size(); ++lane)
    while (feed(lane) || send(lane)) {
    }
  while (free_threads_ > 0 && (trace() || trace_again())) {
  }
  if (free_threads_ > 0) wake_idle_threads();
}

/// A batch for the lane, when the one before it is sent.
bool Simulation::feed(std::size_t l) {
  if (gpus_[l].to_send > 0) return false;
  if (remaining_ > 0) {
    const std::size_t rays = lane_batch(situation(), l);
    if (rays > 0) take_off(l, rays, {});
    remaining_ -= rays;
    return rays > 0;
  }
  const auto again = lane_again(situation(), l);
  if (again) take_off(l, again->rays, borrow(*again));
  return again.has_value();
}

void Simulation::take_off(std::size_t l, std::size_t rays, std::optional<Borrowed> borrowed) {
  const double sending = gpus_[l].walk * static_cast<double>(rays) / static_cast<double>(crew_.threads);
  lanes_[l].flights.push_back({rays, borrowed ? 0 : rays, now_ + sending});
  gpus_[l].tickets.push_back({next_id_++, borrowed ? 0 : rays, borrowed});
  if (gpus_[l].walk > 0)
    gpus_[l].to_send = gpus_[l].unsent = rays;
  else
    submit(l);
}

/// A thread sends a part of the newest batch.
bool Simulation::send(std::size_t l) {
  Gpu& gpu = gpus_[l];
  if (gpu.unsent == 0 || free_threads_ == 0) return false;
  const std::size_t rays = std::min(gpu.unsent, crew_.largest);
  gpu.unsent -= rays;
  --free_threads_;
  at(now_ + gpu.walk * static_cast<double>(rays), [=, this] {
    ++free_threads_;
    if ((gpus_[l].to_send -= rays) == 0) submit(l);
  });
  return true;
}

void Simulation::submit(std::size_t l) {
  const std::uint64_t id = gpus_[l].tickets.back().id;
  const std::size_t rays = lanes_[l].flights.back().rays;
  lanes_[l].flights.back().since = now_;
  const double done = gpus_[l].queue.done(now_, rays);
  const bool fails = done > gpus_[l].breaks;
  const double time = fails ? std::max(now_, gpus_[l].breaks) : done;
  if (time < std::numeric_limits<double>::infinity()) at(time, [=, this] { land(l, id, fails); });
}

std::size_t Simulation::place(std::size_t l, std::uint64_t id) const {
  const auto& tickets = gpus_[l].tickets;
  const auto found = std::ranges::find(tickets, id, &Ticket::id);
  return static_cast<std::size_t>(found - tickets.begin());
}

void Simulation::land(std::size_t l, std::uint64_t id, bool failed) {
  Gpu& gpu = gpus_[l];
  const std::size_t at = place(l, id);
  const Flight flight = lanes_[l].flights[at];
  const Ticket ticket = gpu.tickets[at];
  lanes_[l].flights.erase(lanes_[l].flights.begin() + static_cast<std::ptrdiff_t>(at));
  gpu.tickets.erase(gpu.tickets.begin() + static_cast<std::ptrdiff_t>(at));
  if (failed) {
    lanes_[l].lost = true;
    failed_.insert(id);
    remaining_ += flight.open;
    if (ticket.borrowed) give_back(*ticket.borrowed);
  } else {
    learn(lanes_[l], flight, now_);
    by_gpu_ += ticket.unanswered;
    answer(ticket.unanswered);
    if (ticket.borrowed) answer(*ticket.borrowed);
  }
}

Simulation::Borrowed Simulation::borrow(const Again& again) {
  lanes_[again.lane].flights[again.flight].open -= again.rays;
  twice_ += again.rays;
  return {again.lane, gpus_[again.lane].tickets[again.flight].id, again.rays};
}

/// Answers what the flight itself has not.
void Simulation::answer(const Borrowed& borrowed) {
  auto& tickets = gpus_[borrowed.lane].tickets;
  const std::size_t at = place(borrowed.lane, borrowed.id);
  if (at < tickets.size()) tickets[at].unanswered -= borrowed.rays;
  if (at < tickets.size() || failed_.contains(borrowed.id)) answer(borrowed.rays);
}

void Simulation::give_back(const Borrowed& borrowed) {
  const std::size_t at = place(borrowed.lane, borrowed.id);
  if (at < gpus_[borrowed.lane].tickets.size())
    lanes_[borrowed.lane].flights[at].open += borrowed.rays;
  else if (failed_.contains(borrowed.id))
    remaining_ += borrowed.rays;
}

void Simulation::occupy_thread(std::size_t rays, const std::function<void()>& done) {
  --free_threads_;
  busy_until_.push_back(now_ + crew_.model.predict(rays));
  const double seconds = call_overhead + processor_.alone(rays);
  at(now_ + seconds, [=, this] {
    ++free_threads_;
    crew_.model.add(rays, seconds);
    done();
  });
}

bool Simulation::trace() {
  const std::size_t rays = remaining_ > 0 ? crew_batch(situation()) : 0;
  if (rays == 0) return false;
  remaining_ -= rays;
  occupy_thread(rays, [=, this] { answer(rays); });
  return true;
}

bool Simulation::trace_again() {
  if (remaining_ > 0) return false;
  const auto again = crew_again(situation());
  if (!again) return false;
  occupy_thread(again->rays, [=, this, borrowed = borrow(*again)] { answer(borrowed); });
  return true;
}

/// Threads look again when a flight is late, and every while when they left the rest of the pool to the lanes.
void Simulation::wake_idle_threads() {
  double time = std::numeric_limits<double>::infinity();
  if (remaining_ > 0) time = now_ + 1e-4;
  for (const Lane& lane : lanes_)
    for (std::size_t f = 0; f < lane.flights.size(); ++f)
      for (const double moment : {forecast(lane, f).finish, forecast(lane, f).late})
        if (lane.flights[f].open > 0 && moment > now_) time = std::min(time, moment * (1 + 1e-9) + 1e-9);
  if (time >= next_wake_ && next_wake_ > now_) return;
  next_wake_ = time;
  at(time, [] {});
}

}  // namespace

Outcome simulate(const MadeMachine& machine, std::size_t rays, std::uint64_t seed) {
  return Simulation(machine, rays, seed).run();
}

}  // namespace rayengine
