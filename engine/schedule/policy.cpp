#include "engine/schedule/policy.h"

#include <algorithm>
#include <cmath>

namespace rayengine {
namespace {

constexpr double percentile_99 = 2.33;  // standard deviations
constexpr double hidden_latency = 9;    // a batch is large enough when it works so many times as long as it waits
constexpr double first_share = 0.15;    // of the pool, in each batch sent to a lane before it answers
constexpr double first_walk = 0.05;     // of the processor's time for the pool, spent on sending those

/// Seconds from now until the lane would begin with a batch handed over now.
double start(const Lane& lane, double now) { return std::max(lane.model.latency(), ready(lane, now) - now); }

/// Whether the processor gains by sending rays there.
bool pays(const Lane& lane, const Crew& crew) {
  return !lane.lost && lane.model.known() && !(crew.model.known() && lane.walk >= crew.model.per_ray());
}

/// Seconds a ray at which a lane answers when it always has as many batches as it can, of the largest size.
double pace(const Lane& lane) {
  const double of_one = lane.model.latency() / static_cast<double>(lane.largest) + lane.model.per_ray();
  return std::max(lane.model.per_ray(), of_one / static_cast<double>(lane.depth));
}

/// Rays that all threads can send in time for the lane to answer them within `seconds`.
double most_sent(const Situation& s, const Lane& lane, double seconds) {
  const double sending = std::max(0.0, seconds - lane.model.latency()) * static_cast<double>(s.crew.threads);
  return lane.walk > 0 ? sending / lane.walk : forever;
}

/// Rays that can be answered within `seconds`, of which `lanes[i]` answers share[i].
double capacity(const Situation& s, double seconds, std::span<double> share) {
  double processor = std::max(0.0, seconds * static_cast<double>(s.crew.threads) - s.crew.owed), total = 0;
  for (std::size_t i = 0; i < s.lanes.size(); ++i) {
    const Lane& lane = s.lanes[i];
    const double working = std::max(0.0, seconds - start(lane, s.now));
    share[i] = pays(lane, s.crew) ? std::min(working / pace(lane), most_sent(s, lane, seconds)) : 0;
    share[i] = lane.walk > 0 ? std::min(share[i], processor / lane.walk) : share[i];
    processor -= share[i] * lane.walk;
    total += share[i];
  }
  return s.crew.model.known() ? total + processor / s.crew.model.per_ray() : total;
}

/// A time within which everything can surely be answered.
double enough(const Situation& s) {
  const double rays = static_cast<double>(s.remaining);
  double least = s.crew.model.known()
                     ? (s.crew.owed + rays * s.crew.model.per_ray()) / static_cast<double>(s.crew.threads)
                     : forever;
  for (const Lane& lane : s.lanes)
    if (pays(lane, s.crew)) least = std::min(least, start(lane, s.now) + rays * std::max(pace(lane), lane.walk));
  return least;
}

/// drain(), and what each lane answers until then.
double drain(const Situation& s, std::span<double> share) {
  double low = 0, high = enough(s);
  if (high == forever) return forever;
  for (int i = 0; i < 40 && high - low > 1e-3 * high; ++i) {
    const double middle = (low + high) / 2;
    (capacity(s, middle, share) < static_cast<double>(s.remaining) ? low : high) = middle;
  }
  capacity(s, high, share);
  return high;
}

std::size_t rays_of(double rays) { return static_cast<std::size_t>(std::ceil(std::max(0.0, rays))); }

bool any_flight(std::span<const Lane> lanes) {
  return std::ranges::any_of(lanes, [](const Lane& lane) { return !lane.flights.empty(); });
}

/// A batch for a lane that has never answered.
std::size_t first_batch(const Situation& s, const Lane& lane) {
  double sent = 0;
  for (const Flight& flight : lane.flights) sent += static_cast<double>(flight.rays);
  const double pool = static_cast<double>(s.remaining) + sent;
  const double slots = static_cast<double>(lane.depth - lane.flights.size());
  double affordable = pool * first_share;
  if (lane.walk > 0)
    affordable = std::min(affordable, (first_walk * pool * s.crew.model.per_ray() / lane.walk - sent) / slots);
  const std::size_t rays = std::min({rays_of(affordable), s.remaining, lane.largest});
  return rays >= lane.smallest ? rays : lane.flights.empty() ? std::min(lane.smallest, s.remaining) : 0;
}

/// While a lane has not answered it may turn out to be fast: nothing is begun that takes longer than it kept silent.
double patience(const Situation& s) {
  double seconds = forever;
  for (const Lane& lane : s.lanes)
    if (!lane.model.known() && !lane.flights.empty()) seconds = std::min(seconds, s.now - lane.flights.front().since);
  return seconds;
}

/// Seconds for a lane to answer a batch handed over now.
double alone(const Lane& lane, std::size_t rays, double now) {
  return start(lane, now) + lane.model.per_ray() * static_cast<double>(rays);
}

/// Of the flights whose open rays are traced sooner by somebody else, in `seconds(rays)`, or that are late, the one
/// that will be back last. Lane `taker` has no use for its own.
template <class Seconds>
std::optional<Again> last_flight(const Situation& s, std::size_t taker, const Seconds& seconds) {
  std::optional<Again> last;
  double latest = s.now;
  for (std::size_t l = 0; l < s.lanes.size(); ++l)
    for (std::size_t f = 0; l != taker && f < s.lanes[l].flights.size(); ++f) {
      const std::size_t open = s.lanes[l].flights[f].open;
      const auto [due, late] = forecast(s.lanes[l], f);
      const double finish = s.now > due ? 2 * s.now - due : due;
      if (open == 0 || finish < latest || !(s.now + seconds(open) < finish || s.now > late)) continue;
      latest = finish;
      last = Again{l, f, open};
    }
  return last;
}

double largest(const Lane& lane) { return static_cast<double>(lane.largest); }

/// Into how many batches a lane's share is cut: one for each place in the lane that is free, or will be so early that
/// the lane does not run dry by waiting; and two at least unless they would be too small. What may be latency is not
/// waited for once more: until it is told from the rate, only places that are free count.
std::size_t parts(const Lane& lane, double share, double now) {
  std::size_t places = lane.depth - lane.flights.size();
  if (!lane.model.settled()) return places;
  const double work = share * lane.model.per_ray(), begin = now + start(lane, now);
  for (std::size_t f = 0; f < lane.flights.size(); ++f)
    places += forecast(lane, f).finish + lane.model.latency() < begin + work / static_cast<double>(places + 1);
  return places == 1 && work > 2 * hidden_latency * lane.model.latency() ? 2 : places;
}

}  // namespace

Forecast forecast(const Lane& lane, std::size_t flight) {
  if (!lane.model.known()) return {forever, forever};
  double done = lane.last_landing;
  for (const Flight& f : std::span(lane.flights).first(flight + 1))
    done = std::max(f.since + lane.model.latency(), done) + lane.model.per_ray() * static_cast<double>(f.rays);
  return {done, done + percentile_99 * lane.model.spread() * (done - lane.flights[flight].since)};
}

void learn(Lane& lane, const Flight& flight, double now) {
  // Behind another flight the latency passes unseen, unless the other one was back before.
  const bool waited = lane.last_landing > flight.since + lane.model.latency();
  lane.model.add(flight.rays, now - (waited ? lane.last_landing : flight.since), waited);
  lane.last_landing = now;
}

double ready(const Lane& lane, double now) {
  if (lane.flights.empty() || !lane.model.known()) return now;
  const double finish = forecast(lane, lane.flights.size() - 1).finish;
  return now > finish ? now + (now - finish) : finish;
}

double drain(const Situation& s) {
  std::vector<double> share(s.lanes.size());
  return drain(s, share);
}

std::size_t lane_batch(const Situation& s, std::size_t index) {
  const Lane& lane = s.lanes[index];
  if (lane.lost || lane.flights.size() >= lane.depth || s.remaining == 0) return 0;
  if (!lane.model.known()) return first_batch(s, lane);
  std::vector<double> shares(s.lanes.size());
  const double seconds = drain(s, shares);
  // A batch is sent before it is traced.
  const double most =
      (seconds - lane.model.latency()) / (lane.model.per_ray() + lane.walk / static_cast<double>(s.crew.threads));
  const double share = std::min({shares[index], static_cast<double>(s.remaining), most});
  const double wanted = share / static_cast<double>(parts(lane, share, s.now));
  return rays_of(std::min({std::max(wanted, static_cast<double>(lane.smallest)), share, largest(lane)}));
}

std::size_t crew_batch(const Situation& s) {
  const std::size_t least = std::min(s.crew.smallest, s.remaining);
  if (!s.crew.model.known()) return least;
  const double each = s.crew.model.per_ray(),
               seconds = std::min(drain(s), std::max(patience(s), 2 * each * static_cast<double>(least)));
  // Half a thread's share; the last one may be done a little after the lanes.
  const auto half = rays_of(seconds / each / 2);
  if (half >= least) return std::min({half, s.crew.largest, s.remaining});
  return each * static_cast<double>(least) <= 2 * seconds || !any_flight(s.lanes) ? least : 0;
}

std::optional<Again> crew_again(const Situation& s) {
  const double each = s.crew.model.per_ray() / static_cast<double>(s.crew.threads);
  auto again = last_flight(s, s.lanes.size(), [&](std::size_t rays) { return each * static_cast<double>(rays); });
  if (again) again->rays = std::min(again->rays, s.crew.largest);
  return again;
}

std::optional<Again> lane_again(const Situation& s, std::size_t index) {
  const Lane& lane = s.lanes[index];
  if (lane.flights.size() >= lane.depth || !pays(lane, s.crew)) return {};
  auto again = last_flight(s, index, [&](std::size_t rays) { return alone(lane, rays, s.now); });
  if (!again) return {};
  // Batches cannot be taken back from a slow lane: only the fastest gets them.
  for (std::size_t l = 0; l < s.lanes.size(); ++l)
    if (l != again->lane && pays(s.lanes[l], s.crew) &&
        alone(s.lanes[l], again->rays, s.now) < alone(lane, again->rays, s.now))
      return {};
  again->rays = std::min(again->rays, lane.largest);
  return again;
}

}  // namespace rayengine
