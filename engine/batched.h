#pragma once

#include "engine/query.h"

namespace rayengine {

/// A tracer whose every query is cut into batches and asked from all threads (see query.h), and tells how far it is.
class Batched : public Tracer {
 public:
  /// `tracer` must outlive this.
  explicit Batched(Tracer& tracer, RaysDone done = {}) : tracer_(tracer), done_(std::move(done)) {}

  std::string_view name() const override { return tracer_.name(); }
  Precision precision() const override { return tracer_.precision(); }
  Limits limits() const override { return tracer_.limits(); }
  double build_seconds() const override { return tracer_.build_seconds(); }
  std::size_t bytes() const override { return tracer_.bytes(); }
  std::uint64_t resolved_rays() const override { return tracer_.resolved_rays(); }

  void closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) override {
    rayengine::closest(tracer_, rays, hits, ray_class, done_);
  }
  void any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) override {
    rayengine::any(tracer_, rays, status, ray_class, done_);
  }
  HitLists all(std::span<const Ray> rays) override { return rayengine::all(tracer_, rays, done_); }

 private:
  Tracer& tracer_;
  RaysDone done_;
};

}  // namespace rayengine
