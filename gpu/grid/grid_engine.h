#pragma once

#include <memory>
#include <optional>

#include "gpu/device_engine.h"
#include "gpu/grid/grid_kernels.h"
#include "gpu/grid/grid_tracer.h"

namespace rayengine {

/// The grid tracer's loop (see make_grid_tracer).
class GridEngine : public DeviceEngine {
 public:
  GridEngine(std::shared_ptr<const Geometry> geometry, const GridTracerOptions& options);

  void trace(std::span<const Ray> rays, StreamQuery query, const Arrive& arrive) override;

  const GpuInfo& gpu() const override { return context_.info(); }
  std::size_t batch_rays() const override { return batch_->capacity(); }
  std::size_t bytes() const override { return textures_->bytes(); }

 private:
  GridKernels& kernels(StreamQuery query);
  void upload(std::span<const Traveller> travellers);
  void answer(std::span<Traveller> travellers, StreamQuery query);

  GridTracerOptions options_;
  Context context_;
  FlatScene scene_;
  LocalFrame frame_;
  std::uint32_t first_list_ = no_id;  ///< of what has no bounds, if anything has none
  std::optional<GridTextures> textures_;
  std::optional<GridKernels> closest_, any_;
  std::optional<StreamBatch> batch_;
};

}  // namespace rayengine
