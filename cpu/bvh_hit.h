#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "accel/geometry.h"
#include "accel/ray.h"
#include "cpu/isa/bvh_job.h"

namespace rayengine {

/// What was hit in a geometry or, through one of its instances, in a group.
struct BvhFound {
  const Geometry* geometry = nullptr;
  const Instance* instance = nullptr;  ///< null when it is not instanced
  BvhAnswer answer{};
};

/// A CollectAnswer for a std::vector<BvhAnswer>.
void append(void* answers, const BvhAnswer& answer);

/// The answer to `ray`, in the terms of the geometry that rays are traced in.
Hit hit_of(const Ray& ray, const BvhFound& found);

/// The answers to as many rays, put together in place: to copy a Hit just written is to wait for all of its parts.
void store_hits(const Geometry& geometry, const Ray* rays, std::span<const BvhAnswer> answers, Hit* hits);

/// The answers to so many rays are still in a near cache when hits are made of them; fewer would part the rays too
/// often.
constexpr std::size_t longest_run = 512;

/// Runs of rays, of at most longest_run, that `may` be traced together to `together(first, last)`, others one by one to
/// `alone(i)`.
template <class May, class Together, class Alone>
void for_runs(std::span<const Ray> rays, May&& may, Together&& together, Alone&& alone) {
  for (std::size_t first = 0, last; first < rays.size(); first = last) {
    const std::size_t end = std::min(first + longest_run, rays.size());
    for (last = first; last < end && may(rays[last]);) ++last;
    if (last > first)
      together(first, last);
    else
      alone(last++);
  }
}

}  // namespace rayengine
