#include "gpu/objects/ray_caster.h"

#include <optional>

#include "gpu/device/gl_thread.h"
#include "gpu/objects/objects_engine.h"
#include "gpu/objects/shade_pass.h"

namespace rayengine {

/// Made, used and destroyed on the thread of its context.
struct RayCaster::Device {
  Device(const std::shared_ptr<const Geometry>& geometry, std::span<const CastLight> lights,
         std::span<const CastMaterial> materials, int number)
      : engine(geometry, Precision::half, number),
        shade(*geometry, engine.frame(), lights, materials, engine.batch_side()) {}

  void cast(std::span<const Ray> rays, std::span<glm::vec4> colors) {
    std::vector<Traveller> batch;
    std::vector<glm::vec4> seen;
    for (std::size_t next = 0; next < rays.size();) {
      batch.clear();
      for (; next < rays.size() && batch.size() < engine.batch_rays(); ++next)
        if (is_valid(rays[next]))
          batch.push_back({.ray = static_cast<std::uint32_t>(next), .frame = in_frame(engine.frame(), rays[next])});
      engine.cast(batch);
      seen.resize(batch.size());
      shade.run(seen, engine.context());
      for (std::size_t i = 0; i < batch.size(); ++i) colors[batch[i].ray] = seen[i];
    }
  }

  ObjectsEngine engine;
  ShadePass shade;
};

RayCaster::RayCaster(std::shared_ptr<const Geometry> geometry, std::span<const CastLight> lights,
                     std::span<const CastMaterial> materials, int device)
    : thread_(std::make_unique<GlThread>()) {
  thread_->run([&] { device_ = std::make_unique<Device>(geometry, lights, materials, device); });
}

RayCaster::~RayCaster() {
  thread_->run([this] { device_.reset(); });
}

std::vector<glm::vec4> RayCaster::cast(std::span<const Ray> rays) {
  std::vector<glm::vec4> colors(rays.size(), glm::vec4(0));
  thread_->run([&] { device_->cast(rays, colors); });
  return colors;
}

const GpuInfo& RayCaster::gpu() const { return device_->engine.gpu(); }

}  // namespace rayengine
