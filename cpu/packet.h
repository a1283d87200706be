#pragma once

#include <embree3/rtcore.h>

#include <cstdint>

#include "accel/isa/isa.h"
#include "accel/ray.h"
#include "cpu/quadric_bucket.h"

namespace rayengine {

/// A packet of rays as Embree and the quadric callbacks take them: EmbreeRays is RTCRay... or RTCRayHit... of 1, 8
/// or 16.
template <class EmbreeRays>
struct Packet {
  QuadricContext context;
  alignas(64) EmbreeRays rays;
  alignas(64) int valid[packet_size];  ///< Embree's mask: -1 or 0
  std::uint32_t status[packet_size];   ///< status_invalid or 0
};

/// Rays within these bounds go to Embree as they are. Sums of absolute components are compared, which NaN never passes.
struct OrdinaryRays {
  double farthest = 0;               ///< of an origin
  double shortest = 0, longest = 0;  ///< of a direction
};

/// Loads a full packet (8 or 16 rays) when all its rays are ordinary, else returns false. `soa` is Embree's packet:
/// fields of `lanes` floats, of which origin, tnear, direction and tfar are written; bounds are rounded outward.
using LoadPacket = bool (*)(const OrdinaryRays& ordinary, const Ray* rays, int lanes, QuadricContext& context,
                            float* soa);

LoadPacket packet_loader(Isa isa);

namespace sse2 {
bool load_packet(const OrdinaryRays&, const Ray*, int, QuadricContext&, float*);
}
namespace avx2 {
bool load_packet(const OrdinaryRays&, const Ray*, int, QuadricContext&, float*);
}
namespace avx512 {
bool load_packet(const OrdinaryRays&, const Ray*, int, QuadricContext&, float*);
}

}  // namespace rayengine
