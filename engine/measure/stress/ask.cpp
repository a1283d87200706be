#include "engine/measure/stress/ask.h"

#include <algorithm>

#include "engine/query.h"

namespace rayengine::stability {
namespace {

constexpr std::uint32_t never_written = 0xA5A5A5A5u;

/// Whether something is hit, told as a hit of the first primitive.
Hit as_hit(std::uint32_t status) {
  if (status == never_written) return unanswered();
  Hit hit;
  hit.status = status;
  if (hit.hit()) hit.t = 1, hit.object = hit.primitive = 0;
  return hit;
}

std::vector<Hit> ask_any(Tracer& tracer, const Case& one) {
  std::vector<std::uint32_t> status(one.rays.size(), never_written);
  rayengine::any(tracer, one.rays, status, one.ray_class);
  std::vector<Hit> hits;
  for (const std::uint32_t s : status) hits.push_back(as_hit(s));
  return hits;
}

/// The k-th hits of both lists of a ray side by side; where one is shorter it misses.
struct Pairs {
  std::vector<Ray> rays;
  std::vector<Hit> hits, exact;

  Pairs(std::span<const Ray> from, const Asked& a, const Asked& b) {
    for (std::size_t i = 0; i < from.size(); ++i) {
      const std::uint64_t longer = std::max(length(a, i), length(b, i));
      for (std::uint64_t k = 0; k < longer; ++k) {
        rays.push_back(from[i]);
        hits.push_back(at(a, i, k));
        exact.push_back(at(b, i, k));
      }
    }
  }

 private:
  static std::uint64_t length(const Asked& asked, std::size_t i) { return asked.offsets[i + 1] - asked.offsets[i]; }
  static Hit at(const Asked& asked, std::size_t i, std::uint64_t k) {
    return k < length(asked, i) ? asked.hits[asked.offsets[i] + k] : Hit{};
  }
};

/// A twin's normals point elsewhere, as its scene is turned.
std::vector<Hit> with_normals_of(std::vector<Hit> exact, std::span<const Hit> hits) {
  for (std::size_t i = 0; i < exact.size(); ++i) exact[i].normal = hits[i].normal;
  return exact;
}

}  // namespace

Asked ask(Tracer& tracer, const Case& one) {
  if (one.query == Query::any) return {ask_any(tracer, one), {}};
  if (one.query == Query::all) {
    HitLists lists = rayengine::all(tracer, one.rays);
    return {std::move(lists.hits), std::move(lists.offsets)};
  }
  Asked asked{std::vector<Hit>(one.rays.size(), unanswered()), {}};
  rayengine::closest(tracer, one.rays, asked.hits, one.ray_class);
  return asked;
}

Comparison judge(const Case& one, const Limits& limits, const Asked& asked, const Asked& exact, Tracer* oracle) {
  const Geometry& geometry = *one.geometry;
  if (one.query == Query::all) {
    const Pairs pairs(one.rays, asked, exact);
    return rayengine::judge({geometry, limits, pairs.rays, one.ray_class, pairs.hits, pairs.exact}, oracle);
  }
  const std::vector<Hit> right = one.twin ? with_normals_of(exact.hits, asked.hits) : exact.hits;
  return rayengine::judge({geometry, limits, one.rays, one.ray_class, asked.hits, right}, oracle);
}

}  // namespace rayengine::stability
