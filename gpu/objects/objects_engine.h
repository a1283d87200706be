#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "accel/tracer.h"
#include "accel/treelets.h"
#include "gpu/device/program.h"
#include "gpu/device_engine.h"
#include "gpu/objects/objects_batch.h"
#include "gpu/scene/scene_textures.h"

namespace rayengine {

/// The objects tracer's loop (see make_objects_tracer).
class ObjectsEngine : public DeviceEngine {
 public:
  ObjectsEngine(std::shared_ptr<const Geometry> geometry, Precision precision, int device);

  void trace(std::span<const Ray> rays, StreamQuery query, const Arrive& arrive) override;

  const GpuInfo& gpu() const override { return context_.info(); }
  std::size_t batch_rays() const override { return batch_->capacity(); }
  std::size_t bytes() const override { return textures_.bytes; }

  GLsizei batch_side() const;
  Context& context() { return context_; }
  const LocalFrame& frame() const { return list_.frame; }
  /// Issues all passes for one batch, after which its rays and nearest hits are bound, to be read on the device.
  void cast(std::span<const Traveller> travellers);

 private:
  /// One object of one type, or a run of a mesh.
  struct Pass {
    std::size_t type;  // index into textures_.types
    std::uint32_t first, count;
  };

  std::vector<Pass> passes() const;
  Context context_;
  FlatScene scene_;
  Treelets list_;  // all primitives, by type, in no structure
  SceneTextures textures_;
  std::vector<Program> programs_;  // by type
  std::vector<Pass> passes_;
  VertexArray vertices_ = make_vertex_array();
  std::optional<ObjectsBatch> batch_;
};

}  // namespace rayengine
