#include "engine/certify.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rayengine {
namespace {

/// The ray, up to what surely lies behind a hit that a robust tracer places at t.
Ray cut_behind(Ray ray, const Hit& proposed) {
  if (proposed.hit()) ray.tmax = std::min(ray.tmax, proposed.t + 0x1p-10 * std::abs(proposed.t) + proposed.error);
  return ray;
}

class Certifying final : public Tracer {
 public:
  Certifying(std::unique_ptr<Tracer> proposer, std::unique_ptr<Tracer> certifier)
      : proposer_(std::move(proposer)), certifier_(std::move(certifier)) {}

  std::string_view name() const override { return proposer_->name(); }
  Precision precision() const override { return Precision::certified; }
  double build_seconds() const override { return proposer_->build_seconds() + certifier_->build_seconds(); }
  std::size_t bytes() const override { return proposer_->bytes() + certifier_->bytes(); }
  std::uint64_t resolved_rays() const override { return certifier_->resolved_rays(); }
  Limits limits() const override {
    Limits limits = certifier_->limits();
    const Limits from = proposer_->limits();
    limits.concurrent = from.concurrent, limits.batch = from.batch, limits.cuts = from.cuts;
    return limits;
  }

  void closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) override {
    check_lengths(rays.size(), hits.size());
    std::vector<Hit> proposed(rays.size());
    proposer_->closest(rays, proposed, ray_class);
    std::vector<Ray> cut(rays.size());
    std::transform(rays.begin(), rays.end(), proposed.begin(), cut.begin(), cut_behind);
    certifier_->closest(cut, hits, ray_class);
    again(rays, proposed, hits, ray_class);
  }

  void any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) override {
    certifier_->any(rays, status, ray_class);
  }

  HitLists all(std::span<const Ray> rays) override { return certifier_->all(rays); }

 private:
  /// Traces whole the rays of which a hit was proposed that there is not.
  void again(std::span<const Ray> rays, std::span<const Hit> proposed, std::span<Hit> hits, RayClass ray_class) {
    std::vector<Ray> whole;
    std::vector<std::size_t> which;
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (proposed[i].hit() && !hits[i].hit()) whole.push_back(rays[i]), which.push_back(i);
    std::vector<Hit> answers(whole.size());
    certifier_->closest(whole, answers, ray_class);
    for (std::size_t i = 0; i < which.size(); ++i) hits[which[i]] = answers[i];
  }

  std::unique_ptr<Tracer> proposer_, certifier_;
};

}  // namespace

std::unique_ptr<Tracer> make_certifying(std::unique_ptr<Tracer> proposer, std::unique_ptr<Tracer> certifier) {
  return std::make_unique<Certifying>(std::move(proposer), std::move(certifier));
}

}  // namespace rayengine
