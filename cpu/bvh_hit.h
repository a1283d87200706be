#pragma once

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

/// Runs of rays that `may` be traced together to `together(first, last)`, others one by one to `alone(i)`.
template <class May, class Together, class Alone>
void for_runs(std::span<const Ray> rays, May&& may, Together&& together, Alone&& alone) {
  for (std::size_t first = 0, last; first < rays.size(); first = last) {
    for (last = first; last < rays.size() && may(rays[last]);) ++last;
    if (last > first)
      together(first, last);
    else
      alone(last++);
  }
}

}  // namespace rayengine
