#pragma once

#include <embree3/rtcore.h>

#include <cstdint>
#include <vector>

#include "accel/geometry.h"
#include "accel/isa/isa.h"
#include "accel/tracer.h"
#include "cpu/quadric_kind.h"

namespace rayengine {

inline constexpr int packet_size = 16;

/// The quadrics of one kind of a geometry: one Embree user geometry, whose callbacks know the kind.
struct QuadricBucket {
  const Geometry* geometry = nullptr;
  std::vector<std::uint32_t> quadrics;  ///< Embree's primID to the index in Geometry::quadrics
  /// What EmbreeScene says of their boxes: all sides are moved out by the first, none further than the second.
  double padding = 0, reach = 0;
};

/// Collects every hit of one ray; used by all-hits queries instead of the lanes' nearest.
struct HitCollector {
  struct Entry {
    double t;
    std::uint32_t geom, prim, inst;
    float u, v;  ///< barycentrics, or the part of a quadric in u
  };
  std::vector<Entry> entries;
};

/// Out of line, so that no instruction set's code holds parts of the standard library.
void collect_hit(HitCollector& collector, const HitCollector::Entry& entry);

/// What the callbacks see of the rays beyond Embree's single precision: up to 16 rays in double, by lanes.
/// It begins with Embree's own context, a pointer to which is how it travels.
struct alignas(64) QuadricContext {
  RTCIntersectContext embree;
  const std::vector<Instance>* instances = nullptr;  ///< by Embree's instID
  HitCollector* collector = nullptr;
  int lane = 0;  ///< where a ray is found that is traced alone
  alignas(64) double ox[packet_size], oy[packet_size], oz[packet_size];
  alignas(64) double dx[packet_size], dy[packet_size], dz[packet_size];
  alignas(64) double tmin[packet_size];
  alignas(64) double nearest[packet_size];  ///< the nearest t so far; just above tmax at first
  alignas(64) double object[packet_size];   ///< the object it belongs to, for ties
  alignas(64) double shift[packet_size];    ///< t at the origin of Embree's ray, which starts near the scene
  alignas(64) double rate[packet_size];     ///< Embree's t is (t - shift) * rate; a power of two
  alignas(64) double scale[packet_size];    ///< 1 / rate
};

/// The callbacks of one instruction set, by kind of quadric.
struct QuadricCallbacks {
  RTCIntersectFunctionN intersect[quadric_kind_count];
  RTCOccludedFunctionN occluded[quadric_kind_count];
};

/// `fast` tests in single precision on Embree's rays; anything above in double on the rays of the context.
const QuadricCallbacks& quadric_callbacks(Isa isa, Precision precision);

namespace sse2 {
extern const QuadricCallbacks fast_callbacks, robust_callbacks;
}
namespace avx2 {
extern const QuadricCallbacks fast_callbacks, robust_callbacks;
}
namespace avx512 {
extern const QuadricCallbacks fast_callbacks, robust_callbacks;
}

}  // namespace rayengine
