#pragma once

#include "gpu/cones/cones_pass.h"
#include "gpu/cones/cones_tracer.h"
#include "gpu/device_engine.h"
#include "gpu/stream/stream_batch.h"
#include "gpu/stream/stream_order.h"

namespace rayengine {

/// The cones tracer's loop (see make_cones_tracer).
class ConesEngine : public DeviceEngine {
 public:
  ConesEngine(std::shared_ptr<const Geometry> geometry, const ConesOptions& options);

  void trace(std::span<const Ray> rays, StreamQuery query, const Arrive& arrive) override;

  const GpuInfo& gpu() const override { return context_.info(); }
  std::size_t batch_rays() const override { return batch_.capacity(); }
  std::size_t bytes() const override { return scene_.bytes(); }

 private:
  void take_places(std::span<const Traveller> travellers);
  void write(std::span<const Traveller> travellers);
  void cast(std::span<Traveller> travellers);
  void test_unbounded() const;

  Context context_;
  ConesScene scene_;
  GLsizei side_;
  ConesPass pass_;
  std::vector<Program> unbounded_;  // by run
  VertexArray vertices_ = make_vertex_array();
  StreamBatch batch_;
  std::vector<SortKey> order_, spare_;  // who lies where in the batch
};

}  // namespace rayengine
