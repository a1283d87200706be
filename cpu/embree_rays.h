#pragma once

#include <span>

#include "cpu/embree_scene.h"
#include "cpu/packet.h"

namespace rayengine {

/// Turns rays into what single precision holds best: moved in double to where they enter the scene's box, and scaled
/// when their directions are very long or very short. Source of the first idea: Wald, "Improving Numerical Precision in
/// Intersection Programs" (Ray Tracing Gems II, ch. 34).
class RayLoader {
 public:
  RayLoader(const EmbreeScene& scene, Precision precision);

  /// Sets what all packets have in common.
  template <class EmbreeRays>
  void begin(int lanes, bool coherent, Packet<EmbreeRays>& packet) const;

  /// Loads rays.size() <= `lanes` rays into a packet of `lanes` (1, 8 or 16); true when any of them can hit.
  template <class EmbreeRays>
  bool load(std::span<const Ray> rays, int lanes, Packet<EmbreeRays>& packet) const;

 private:
  struct Placed {
    double shift = 0, scale = 1, rate = 1;  // as in QuadricContext
    bool traced = true;
  };
  bool is_ordinary(const Ray& ray) const;
  Placed place(const Ray& ray) const;
  void load_lane(const Ray& ray, const Placed& placed, int lanes, int lane, QuadricContext& context, float* soa) const;

  const EmbreeScene& scene_;
  LoadPacket load_packet_;
  OrdinaryRays ordinary_;
  Box box_;         ///< of everything finite
  bool moves_;      ///< `fast` leaves rays where they are
  bool unbounded_;  ///< some quadric is: rays that pass the box may hit too
};

}  // namespace rayengine
