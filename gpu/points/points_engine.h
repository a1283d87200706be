#pragma once

#include <optional>

#include "gpu/device/program.h"
#include "gpu/device_engine.h"
#include "gpu/grid/gridded_scene.h"
#include "gpu/points/points_tracer.h"

namespace rayengine {

/// The points tracer's loop (see make_points_tracer).
class PointsEngine : public DeviceEngine {
 public:
  PointsEngine(std::shared_ptr<const Geometry> geometry, const PointsTracerOptions& options);

  void trace(std::span<const Ray> rays, StreamQuery query, const Arrive& arrive) override;

  const GpuInfo& gpu() const override { return context_.info(); }
  std::size_t batch_rays() const override { return batch_; }
  std::size_t bytes() const override { return scene_->textures.bytes(); }

 private:
  void answer(std::span<Traveller> travellers, StreamQuery query);

  Context context_;
  std::size_t batch_;
  std::optional<GriddedScene> scene_;
  std::optional<Program> program_;
  MappedBuffer points_, answers_;
  VertexArray vertices_ = make_vertex_array();
  Framebuffer nowhere_ = make_framebuffer();
};

}  // namespace rayengine
