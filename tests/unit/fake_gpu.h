#pragma once

#include <atomic>
#include <chrono>
#include <thread>

#include "cpu/embree_tracer.h"

namespace rayengine::test {

/// What goes wrong with a device, and from which of its batches on.
struct Fault {
  enum class Kind { none, stall, slow, error, lost } kind = Kind::none;
  int batch = 0;
  double seconds = 0;  ///< of the stall
};

/// Embree that takes as long as it is told to, mostly asleep: a device whose rate does not depend on the machine.
class PacedTracer : public Tracer {
 public:
  PacedTracer(std::shared_ptr<const Geometry> geometry, double latency, double per_ray, bool concurrent,
              Fault fault = {})
      : embree_(make_embree_tracer(std::move(geometry), Precision::robust)),
        latency_(latency),
        per_ray_(per_ray),
        concurrent_(concurrent),
        fault_(fault) {}

  std::string_view name() const override { return "paced"; }
  Precision precision() const override { return Precision::robust; }
  Limits limits() const override {
    Limits limits = embree_->limits();
    limits.concurrent = concurrent_;
    return limits;
  }
  double build_seconds() const override { return 0; }
  std::size_t bytes() const override { return 0; }

  void closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) override {
    const Pace pace(*this, rays.size());
    embree_->closest(rays, hits, ray_class);
  }
  void any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) override {
    const Pace pace(*this, rays.size());
    embree_->any(rays, status, ray_class);
  }
  HitLists all(std::span<const Ray> rays) override { return embree_->all(rays); }

  int batches() const { return batches_; }
  bool overlapped() const { return overlapped_; }

 private:
  using Clock = std::chrono::steady_clock;

  /// Does what is to go wrong, and sleeps at its end until the time is over.
  class Pace {
   public:
    Pace(PacedTracer& tracer, std::size_t rays) : tracer_(tracer) {
      if (tracer.inside_++ > 0) tracer.overlapped_ = true;
      const int batch = tracer.batches_++;
      double seconds = tracer.latency_ + tracer.per_ray_ * static_cast<double>(rays);
      const Fault& fault = tracer.fault_;
      if (fault.kind == Fault::Kind::stall && batch == fault.batch) seconds += fault.seconds;
      if (fault.kind == Fault::Kind::slow && batch >= fault.batch) seconds *= 100;
      end_ += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
      const bool fails = (fault.kind == Fault::Kind::error && batch == fault.batch) ||
                         (fault.kind == Fault::Kind::lost && batch >= fault.batch);
      if (!fails) return;
      --tracer.inside_;
      throw Error(fault.kind == Fault::Kind::lost ? "the context is lost" : "a made error");
    }
    ~Pace() {
      std::this_thread::sleep_until(end_);
      --tracer_.inside_;
    }

   private:
    PacedTracer& tracer_;
    Clock::time_point end_ = Clock::now();
  };

  std::unique_ptr<Tracer> embree_;
  double latency_, per_ray_;
  bool concurrent_;
  Fault fault_;
  std::atomic<int> batches_ = 0, inside_ = 0;
  std::atomic<bool> overlapped_ = false;
};

}  // namespace rayengine::test
