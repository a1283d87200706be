#include "engine/measure/recorded.h"

#include <algorithm>

namespace rayengine {

Recorded::Recorded(std::string name, Precision precision, Limits limits, std::span<const Ray> rays,
                   std::span<const Hit> hits)
    : name_(std::move(name)), precision_(precision), limits_(limits), rays_(rays), hits_(hits) {}

std::span<const Hit> Recorded::answers(std::span<const Ray> rays) const {
  const std::ptrdiff_t first = rays.data() - rays_.data();
  if (first < 0 || first + rays.size() > rays_.size())
    throw Error("the answers of '" + name_ + "' were not recorded for these rays");
  return hits_.subspan(static_cast<std::size_t>(first), rays.size());
}

void Recorded::closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass) {
  std::ranges::copy(answers(rays), hits.begin());
}

void Recorded::any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass) {
  std::ranges::transform(answers(rays), status.begin(),
                         [](const Hit& hit) { return hit.status & (status_hit | status_invalid); });
}

HitLists Recorded::all(std::span<const Ray>) { throw Error("only the nearest hits of '" + name_ + "' were recorded"); }

}  // namespace rayengine
