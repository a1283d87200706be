#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/schedule/cost_model.h"

// What to send where, as functions of measured numbers: no device, clock or thread in here. Times are in seconds from
// any beginning.
namespace rayengine {

/// A batch that a GPU has.
struct Flight {
  std::size_t rays = 0;
  std::size_t open = 0;  ///< of them, neither answered nor handed to the processor as well
  double since = 0;      ///< when it was handed over
};

/// A GPU as the scheduler sees it.
struct Lane {
  CostModel model;
  double walk = 0;               ///< processor time to send one ray, of one thread
  std::size_t smallest = 1024;   ///< rays of the first batch, and about the fewest that are worth sending
  std::size_t largest = 262144;  ///< rays of a batch
  std::size_t depth = 3;         ///< batches at once
  bool lost = false;             ///< gets nothing any more
  std::vector<Flight> flights;   ///< oldest first
  double last_landing = 0;       ///< when the last one came back
};

/// The processor's threads. `model` is that of one thread.
struct Crew {
  CostModel model;
  std::size_t threads = 1;
  std::size_t smallest = 256, largest = 4096;  ///< rays that a thread takes at once
  double owed = 0;                             ///< processor time that threads will still take for what they have
};

struct Situation {
  double now = 0;
  std::size_t remaining = 0;  ///< rays in the pool that nobody has
  const Crew& crew;
  std::span<const Lane> lanes;
};

/// When a flight is predicted to be done, and when 99 % of such flights are. Infinite while too little is known.
struct Forecast {
  double finish = 0, late = 0;
};
Forecast forecast(const Lane& lane, std::size_t flight);

/// Notes that a flight has come back with its answers.
void learn(Lane& lane, const Flight& flight, double now);

/// When the lane will be done with what it has. A flight that is overdue is thought to take as long again as it is
/// over.
double ready(const Lane& lane, double now);

/// Seconds until the pool is done when everybody works on it as long as that helps. Infinite while nobody's rate is
/// known.
double drain(const Situation& s);

/// Rays to hand to a lane now; 0 when it must wait, or could not be done before the others have finished the pool (so
/// that they overflow to the processor). The lane's share of what remains is cut into batches for the places that it
/// has, and so they shrink towards the end; but no smaller than what hides the latency.
///
/// A lane that has never answered gets as many batches as it has places for, each a fixed part of the pool: its latency
/// passes once, not once for each question, and what is lost with one batch that comes back too late is bounded.
std::size_t lane_batch(const Situation& s, std::size_t lane);

/// Rays for a thread of the processor; 0 when the lanes will be done before it could be.
std::size_t crew_batch(const Situation& s);

/// Rays of a flight that somebody else should trace as well.
struct Again {
  std::size_t lane = 0, flight = 0;
  std::size_t rays = 0;
};

/// When the pool is empty, what a thread of the processor should take from the flight that will be back last: all
/// threads together would be done with its open rays before it, or it is late.
std::optional<Again> crew_again(const Situation& s);

/// The same for a lane, which takes the rays from another lane's flight.
std::optional<Again> lane_again(const Situation& s, std::size_t lane);

}  // namespace rayengine
