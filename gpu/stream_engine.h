#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "accel/walk.h"
#include "gpu/device_engine.h"
#include "gpu/stream_kernels.h"
#include "gpu/stream_tracer.h"

namespace rayengine {

/// What the stream tracer's CPU side keeps of a ray between batches.
struct StreamTraveller : Traveller {
  Ray world;  ///< the caller's, with tmax lowered to the best hit
  WalkCursor cursor;
  bool fresh = true;                   ///< has yet to be tested against what has no bounds
  std::uint32_t listed = 0;            ///< treelets in the batch now
  glm::uvec4 treelets{0}, entries{0};  ///< as gpu/shaders/stream/ray.glsl has them
  float last_entry = 0;                ///< where it enters the last of them
};

/// The stream tracer's loop (see make_stream_tracer).
class StreamEngine : public DeviceEngine {
 public:
  StreamEngine(std::shared_ptr<const Geometry> geometry, const StreamOptions& options);

  void trace(std::span<const Ray> rays, StreamQuery query, const Arrive& arrive) override;

  const GpuInfo& gpu() const override { return context_.info(); }
  std::size_t batch_rays() const override { return static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_); }
  std::size_t bytes() const override { return textures_.bytes + treelets_.bytes(); }

 private:
  /// A batch, and those who travel in it.
  struct Slot {
    explicit Slot(GLsizei side) : batch(side) {}
    StreamBatch batch;
    std::vector<StreamTraveller> travellers;
    std::vector<std::uint32_t> order;  ///< by place in the batch
    std::size_t sent = 0;              ///< those before it went to the device; the others had nowhere to go
  };

  StreamTraveller set_out(std::uint32_t index, const Ray& ray) const;
  void look_behind(StreamTraveller& traveller, const Ray& ray) const;
  const StreamKernels& kernels(StreamQuery query);
  void send(Slot& slot, StreamQuery query);
  void list(StreamTraveller& traveller, std::span<const TreeletEntry> found) const;
  void list_block(std::span<StreamTraveller> travellers) const;
  static std::size_t take_places(Slot& slot);
  void dispatch(Slot& slot, StreamQuery query, std::uint32_t rounds);
  static void enter(StreamTraveller& traveller, const StreamBatch::Answer& answer);
  void collect(Slot& slot, std::span<const Ray> rays, StreamQuery query, const Arrive& arrive);
  bool arrived(StreamTraveller& traveller, std::span<const Ray> rays, StreamQuery query, const Arrive& arrive) const;
  void fill(Slot& slot, std::span<const Ray> rays, std::size_t& next);
  bool settled(const StreamTraveller& traveller, StreamQuery query) const;

  StreamOptions options_;
  Context context_;
  GLsizei side_;
  FlatScene scene_;
  Treelets treelets_;
  SceneTextures textures_;
  std::optional<StreamKernels> closest_, any_;
  std::vector<std::unique_ptr<Slot>> slots_;
  std::vector<StreamTraveller> again_;  // back from the device, to be sent on
};

}  // namespace rayengine
