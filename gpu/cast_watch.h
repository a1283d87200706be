#pragma once

namespace rayengine {

/// How long a picture took: on the clock, and of the processor, summed over its cores (of a renderer in software, that
/// is the whole work).
struct CastSeconds {
  double elapsed = 0, processor = 0;
};

/// Adds up the time between start and stop, while the device is made to finish at both.
class CastWatch {
 public:
  void start();
  void stop(double times = 1);
  const CastSeconds& seconds() const { return seconds_; }

 private:
  CastSeconds seconds_, started_;
};

}  // namespace rayengine
