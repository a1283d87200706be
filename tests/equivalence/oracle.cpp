#include "tests/equivalence/oracle.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "cpu/reference_tracer.h"

namespace rayengine::test {
namespace {

/// Answers by the bits of the rays that were asked about.
template <class Answers>
using Remembered = std::map<std::string, Answers>;

template <class Answers, class Ask>
const Answers& recall(Remembered<Answers>& remembered, std::span<const Ray> rays, Ask ask) {
  const auto bytes = std::as_bytes(rays);
  const auto [at, is_new] = remembered.try_emplace({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  if (is_new) ask(at->second);
  return at->second;
}

class RememberingOracle final : public Tracer {
 public:
  explicit RememberingOracle(std::shared_ptr<const Geometry> geometry)
      : oracle_(make_reference_tracer(std::move(geometry))) {}

  std::string_view name() const override { return oracle_->name(); }
  Precision precision() const override { return oracle_->precision(); }
  Limits limits() const override { return oracle_->limits(); }
  double build_seconds() const override { return oracle_->build_seconds(); }
  std::size_t bytes() const override { return oracle_->bytes(); }

  void closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) override {
    std::ranges::copy(recall(hits_, rays,
                             [&](std::vector<Hit>& answers) {
                               answers.resize(rays.size());
                               oracle_->closest(rays, answers, ray_class);
                             }),
                      hits.begin());
  }

  void any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) override {
    std::ranges::copy(recall(status_, rays,
                             [&](std::vector<std::uint32_t>& answers) {
                               answers.resize(rays.size());
                               oracle_->any(rays, answers, ray_class);
                             }),
                      status.begin());
  }

  HitLists all(std::span<const Ray> rays) override {
    return recall(lists_, rays, [&](HitLists& answers) { answers = oracle_->all(rays); });
  }

 private:
  std::unique_ptr<Tracer> oracle_;
  Remembered<std::vector<Hit>> hits_;
  Remembered<std::vector<std::uint32_t>> status_;
  Remembered<HitLists> lists_;
};

}  // namespace

Tracer& oracle_on(const std::shared_ptr<const Geometry>& geometry) {
  static std::map<std::shared_ptr<const Geometry>, RememberingOracle> oracles;
  return oracles.try_emplace(geometry, geometry).first->second;
}

}  // namespace rayengine::test
