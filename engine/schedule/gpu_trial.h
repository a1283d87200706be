#pragma once

#include <algorithm>

namespace rayengine {

/// Finds out whether a GPU pays: the rate of all with it, measured against that of the processor alone before and
/// after, since whatever comes first runs on cold caches. What sending costs the processor is then in the figure,
/// whoever does it and however. A GPU must win two trials in a row, for machines have other things to do as well. One
/// that does not rests, twice as long each time, and is tried again; one that does is asked to prove it again, soon at
/// first and then less often. Pure: told of work done and of the seconds it took.
///
/// Work counts in seconds that one thread of the processor takes for it when nothing else runs, so that rays of all
/// kinds can be added.
class GpuTrial {
 public:
  /// Work done, and the seconds since the last call in which there was any to do.
  void by_crew(double work, double seconds);
  /// `possible`: work a second that the GPU could do at best, by its cost model. Where that is too little the trial is
  /// over.
  void by_gpu(double work, double seconds, double possible);

  bool wants_gpu() const { return phase_ == Phase::waiting || phase_ == Phase::both || phase_ == Phase::on; }
  bool decided() const { return decided_; }
  bool pays() const { return pays_; }
  bool resting() const { return phase_ == Phase::resting; }

  // Of the last trial.
  double rate_alone() const { return last_.alone; }  ///< of the processor without the GPU, work a second
  /// Of all. They can gain no more than the GPU does: the rest is what the machine did meanwhile.
  double rate_both() const { return std::min(last_.crew, last_.alone) + last_.gpu; }
  double gain() const { return last_.alone > 0 ? rate_both() / last_.alone : 0; }
  /// Work that the processor could not do for each that the GPU did.
  double walk_share() const;

 private:
  enum class Phase {
    alone,    ///< the processor is measured
    waiting,  ///< for the GPU's first answer
    both,     ///< all are measured
    after,    ///< the processor is measured again
    on,
    resting
  };
  struct Rate {
    double work = 0, seconds = 0;
    double rate() const { return seconds > 0 ? work / seconds : 0; }
  };

  struct Rates {
    double alone = 0, crew = 0, gpu = 0;
  };

  void pass(double by_crew, double seconds);
  bool measures_alone() const;
  void enter(Phase phase);
  void decide();

  Phase phase_ = Phase::alone;
  double in_phase_ = 0, trial_ = 0, rest_ = 0;  ///< seconds
  int landings_ = 0, won_ = 0;                  ///< trials in a row
  bool decided_ = false, pays_ = false;
  Rate before_, alone_, crew_, gpu_;
  Rates last_;
};

}  // namespace rayengine
