#pragma once

#include <glm/vec4.hpp>
#include <memory>
#include <span>
#include <vector>

#include "accel/geometry.h"
#include "accel/ray.h"

namespace rayengine {

class GlThread;
struct GpuInfo;

/// What a picture of a RayCaster is lit by, and what its surfaces are like: Blinn-Phong.
struct CastLight {
  glm::dvec3 position{0};  ///< or the direction in which its light travels
  bool directional = false;
  glm::vec3 color{1};
};
struct CastMaterial {
  glm::vec3 color{0.8f};
  float ambient = 0, diffuse = 1;  ///< multiply `color`
  float specular = 0, shininess = 30;
  float reflect = 0;  ///< of what a mirror would show; a RayCaster has no mirrors
};

/// Rays cast and shaded on the device, without shadows and reflections: hits do not come back to the CPU. Source: Wood,
/// McCane, King, "Ray Tracing Arbitrary Objects on the GPU" (2004), with rays and hits in 16-bit halves as the paper
/// packs them; see make_objects_tracer.
class RayCaster {
 public:
  /// Object::material indexes `materials`. Throws Error without a GPU, or when a material is missing.
  RayCaster(std::shared_ptr<const Geometry> geometry, std::span<const CastLight> lights,
            std::span<const CastMaterial> materials, int device = -1);
  ~RayCaster();

  /// What each ray sees: linear colour, and 1 where it hits anything, else zeros. Invalid rays see nothing. From any
  /// thread, one at a time. Throws Error when the device fails.
  std::vector<glm::vec4> cast(std::span<const Ray> rays);
  const GpuInfo& gpu() const;

 private:
  struct Device;
  std::unique_ptr<GlThread> thread_;
  std::unique_ptr<Device> device_;
};

}  // namespace rayengine
