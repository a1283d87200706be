#pragma once

#include <functional>
#include <memory>
#include <span>

#include "gpu/device/context.h"
#include "gpu/scene/frame_ray.h"

namespace rayengine {

enum class StreamQuery { closest, any };

/// What is known of a ray between passes over the device.
struct Traveller {
  std::uint32_t ray = 0;  ///< index into the caller's rays
  FrameRay frame;
  float best_t = 0;  ///< in the frame; counts when best_rank is not no_id
  std::uint32_t best_rank = no_id;
  std::uint32_t floor_rank = no_id;  ///< hits at the frame's tmin count if their rank is above this
  glm::vec3 normal{0};               ///< only where the device works it out
};

/// The device's side of a GPU tracer. Lives on the thread of its context.
class DeviceEngine {
 public:
  virtual ~DeviceEngine() = default;

  /// What becomes of a traveller that has its answer: done, or sent to look behind it, as if that hit were not there.
  enum class Next { done, behind };
  using Arrive = std::function<Next(const Traveller&)>;

  /// Sends all valid rays, and calls `arrive`, from several threads, with each that has its answer. Throws Error when
  /// the device fails; the answers that have arrived are good.
  virtual void trace(std::span<const Ray> rays, StreamQuery query, const Arrive& arrive) = 0;

  virtual const GpuInfo& gpu() const = 0;
  virtual std::size_t batch_rays() const = 0;
  /// Of the scene: structures, and textures on the device.
  virtual std::size_t bytes() const = 0;
};

/// Lets a traveller look behind its best hit.
inline void look_behind(Traveller& t) {
  t.floor_rank = t.best_rank;
  t.frame.tmin = t.best_t;
  t.best_rank = no_id;
}

}  // namespace rayengine
