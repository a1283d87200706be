#pragma once

#include <string>
#include <vector>

#include "accel/tracer.h"

namespace rayengine {

/// Answers that were given before, as a tracer: lets compare() judge the very answers that were timed.
class Recorded : public Tracer {
 public:
  /// hits[i] is the answer to rays[i]; both must outlive this, and queries must be of parts of `rays` itself.
  Recorded(std::string name, Precision precision, Limits limits, std::span<const Ray> rays, std::span<const Hit> hits);

  std::string_view name() const override { return name_; }
  Precision precision() const override { return precision_; }
  Limits limits() const override { return limits_; }
  double build_seconds() const override { return 0; }
  std::size_t bytes() const override { return hits_.size_bytes(); }

  void closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) override;
  void any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) override;
  /// Throws Error: more than the nearest hits was never recorded.
  HitLists all(std::span<const Ray> rays) override;

 private:
  std::span<const Hit> answers(std::span<const Ray> rays) const;

  std::string name_;
  Precision precision_;
  Limits limits_;
  std::span<const Ray> rays_;
  std::span<const Hit> hits_;
};

}  // namespace rayengine
