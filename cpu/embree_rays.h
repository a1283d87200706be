#pragma once

#include <embree3/rtcore.h>

#include <span>

#include "cpu/embree_scene.h"

namespace rayengine {

/// A packet of rays as Embree and the quadric callbacks take them: EmbreeRays is RTCRay..., RTCRayHit... of 1, 8 or 16.
template <class EmbreeRays>
struct Packet {
  QuadricContext context;
  alignas(64) EmbreeRays rays;
  alignas(64) int valid[packet_size];  ///< Embree's mask: -1 or 0
  std::uint32_t status[packet_size];   ///< status_invalid or 0
};

/// Turns rays into what single precision holds best: moved in double to where they enter the scene's box, and scaled
/// when their directions are very long or very short. Source of the first idea: Wald, "Improving Numerical Precision in
/// Intersection Programs" (Ray Tracing Gems II, ch. 34).
class RayLoader {
 public:
  RayLoader(const EmbreeScene& scene, Precision precision);

  /// Loads rays.size() <= `lanes` rays, of which `lanes` (1, 8 or 16) are in `packet`; true when any of them can hit.
  template <class EmbreeRays>
  bool load(std::span<const Ray> rays, int lanes, Packet<EmbreeRays>& packet) const;

 private:
  struct Placed {
    double shift, scale;
    bool traced;
  };
  bool is_ordinary(const Ray& ray) const;
  Placed place(const Ray& ray) const;

  Box box_;         ///< of everything finite
  double near_;     ///< origins with no larger coordinate stay where they are
  bool moves_;      ///< `fast` leaves rays as they are
  bool unbounded_;  ///< some quadric is: rays that pass the box may hit too
};

}  // namespace rayengine
