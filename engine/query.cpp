#include "engine/query.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace rayengine {
namespace {

/// Rays at once to who cuts queries itself: now and then it must be told how far it is.
constexpr std::size_t most_at_once = std::size_t{1} << 22;

/// Calls body(index of the batch, first ray, count) for every batch.
template <class Body>
void for_batches(const Tracer& tracer, std::size_t rays, const RaysDone& done, const Body& body) {
  const Limits limits = tracer.limits();
  const std::size_t size = limits.cuts ? most_at_once : std::max<std::size_t>(limits.batch, 1);
  const auto batch = [&](std::size_t index) {
    const std::size_t first = index * size, count = std::min(size, rays - first);
    body(index, first, count);
    if (done) done(count);
  };
  const std::size_t batches = (rays + size - 1) / size;
  if (limits.concurrent && !limits.cuts)
    tbb::parallel_for(std::size_t{0}, batches, batch);
  else
    for (std::size_t index = 0; index < batches; ++index) batch(index);
}

}  // namespace

void closest(Tracer& tracer, std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class, const RaysDone& done) {
  for_batches(tracer, rays.size(), done, [&](std::size_t, std::size_t first, std::size_t count) {
    tracer.closest(rays.subspan(first, count), hits.subspan(first, count), ray_class);
  });
}

void any(Tracer& tracer, std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class,
         const RaysDone& done) {
  for_batches(tracer, rays.size(), done, [&](std::size_t, std::size_t first, std::size_t count) {
    tracer.any(rays.subspan(first, count), status.subspan(first, count), ray_class);
  });
}

HitLists all(Tracer& tracer, std::span<const Ray> rays, const RaysDone& done) {
  const std::size_t size = std::max<std::size_t>(tracer.limits().batch, 1);
  std::vector<HitLists> parts((rays.size() + size - 1) / size);
  for_batches(tracer, rays.size(), done, [&](std::size_t index, std::size_t first, std::size_t count) {
    parts[index] = tracer.all(rays.subspan(first, count));
  });
  HitLists lists{{0}, {}};
  for (HitLists& part : parts) {
    const std::uint64_t base = lists.hits.size();
    for (std::size_t i = 1; i < part.offsets.size(); ++i) lists.offsets.push_back(base + part.offsets[i]);
    lists.hits.insert(lists.hits.end(), part.hits.begin(), part.hits.end());
    part = {};
  }
  return lists;
}

}  // namespace rayengine
