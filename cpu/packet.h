#pragma once

#include <embree3/rtcore.h>

#include <cstdint>

#include "accel/isa/isa.h"
#include "accel/ray.h"
#include "cpu/quadric_bucket.h"

namespace rayengine {

/// Rows of a packet, one number of every lane each, in the order of Embree's RTCRayHit: the first 12 are an RTCRay.
enum Row {
  org_x_row,
  tnear_row = 3,
  dir_x_row,
  time_row = 7,
  tfar_row,
  mask_row,
  id_row,
  flags_row,
  normal_x_row,
  u_row = 15,
  v_row,
  prim_row,
  geom_row,
  inst_row,
  row_count
};

/// Rays as Embree and the quadric callbacks take them, 8 or 16 together.
struct Packet {
  int lanes;
  QuadricContext context;
  alignas(64) float numbers[row_count * packet_size];  ///< an RTCRayHit8 or RTCRayHit16: rows of `lanes`
  alignas(64) int valid[packet_size];                  ///< Embree's mask: -1 or 0
  std::uint32_t status[packet_size];                   ///< status_invalid or 0
  bool odd;  ///< some ray was moved, scaled or left out: Embree's t is not ours

  float* row(int r) { return numbers + r * lanes; }
  const float* row(int r) const { return numbers + r * lanes; }
};

/// A ray without a packet.
struct Single {
  QuadricContext context;
  alignas(64) RTCRayHit ray;
};

/// Rays within these bounds go to Embree as they are. Sums of absolute components are compared, which NaN never passes.
struct OrdinaryRays {
  double farthest = 0;               ///< of an origin
  double shortest = 0, longest = 0;  ///< of a direction
};

/// How the callbacks' hits of quadrics are told from Embree's of triangles (see record() in isa/quadrics.inl).
struct QuadricRows {
  unsigned first_geometry;  ///< quadrics have this geomID or a higher one
  const double* t;          ///< of their hits; null where Embree's is theirs
};

/// What is done to whole packets of 8 or 16 lanes, `numbers` being those of a Packet; one of each instruction set.
struct PacketCode {
  /// Loads the rays when all of them are ordinary, else returns false. Origin, tnear, direction and tfar are written,
  /// bounds rounded outward; and `context` unless it is null.
  bool (*load)(const OrdinaryRays& ordinary, const Ray* rays, int lanes, QuadricContext* context, float* numbers);

  /// Whether rays go into one octant, so that they visit a tree in the same order and gain from packets whatever made
  /// them, and do not spread over all of it.
  bool (*keep_together)(const float* numbers, int lanes);

  /// Every lane as a ray of its own, and back what Embree answers to them.
  void (*spread)(const float* numbers, int lanes, RTCRayHit* singles);
  void (*gather)(const RTCRayHit* singles, int lanes, float* numbers);

  /// Writes Embree's answers as misses, hits of quadrics unless `quadrics` is null, and hits of the triangles of
  /// `object`.
  void (*store)(const float* numbers, int lanes, std::uint32_t object, const QuadricRows* quadrics, Hit* hits);
};

const PacketCode& packet_code(Isa isa);

namespace sse2 {
extern const PacketCode packet_code;
}
namespace avx2 {
extern const PacketCode packet_code;
}
namespace avx512 {
extern const PacketCode packet_code;
}

}  // namespace rayengine
