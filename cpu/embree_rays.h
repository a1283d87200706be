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

  /// Sets what all packets have in common, and their number of lanes.
  void begin(bool coherent, Packet& packet) const;

  /// Loads 1 to packet.lanes rays; false when none of them can hit.
  bool load(std::span<const Ray> rays, Packet& packet) const;

  /// Calls trace(context, ray) for each ray of a packet that can hit, as a packet of one lane.
  template <class Trace>
  void trace_alone(Packet& packet, const Trace& trace) const {
    alignas(64) RTCRayHit alone[packet_size];
    code_.spread(packet.numbers, packet.lanes, alone);
    for (int lane = 0; lane < packet.lanes; ++lane) {
      if (!packet.valid[lane]) continue;
      packet.context.lane = lane;
      trace(&packet.context.embree, &alone[lane]);
    }
    packet.context.lane = 0;
    code_.gather(alone, packet.lanes, packet.numbers);
  }
  /// One ray without a packet; false when it cannot hit.
  bool load(const Ray& ray, Single& single) const;

 private:
  struct Placed {
    double shift = 0, scale = 1, rate = 1;  // as in QuadricContext
    bool traced = true;
  };
  void begin(bool coherent, int lanes, QuadricContext& context, float* numbers) const;
  bool is_ordinary(const Ray& ray) const;
  Placed place(const Ray& ray) const;
  bool load_ordinary(std::span<const Ray> rays, Packet& packet) const;
  /// Into a lane of a packet of any size; false when the ray cannot hit, where it is not valid with that status.
  bool load_lane(const Ray& ray, int lanes, int lane, QuadricContext& context, float* numbers,
                 std::uint32_t& status) const;

  const EmbreeScene& scene_;
  const PacketCode& code_;
  OrdinaryRays ordinary_;
  Box box_;             ///< of everything finite
  bool moves_;          ///< `fast` leaves rays where they are
  bool unbounded_;      ///< some quadric is: rays that pass the box may hit too
  bool reads_context_;  ///< somebody does: the callbacks of quadrics in double
};

}  // namespace rayengine
