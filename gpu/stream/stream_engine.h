#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "accel/walk.h"
#include "gpu/device_engine.h"
#include "gpu/stream/stream_kernels.h"
#include "gpu/stream/stream_order.h"
#include "gpu/stream/stream_tracer.h"

namespace rayengine {

/// What the stream tracer's CPU side keeps of a ray between batches.
struct StreamTraveller : Traveller {
  double tmin = 0, tmax = -1;  ///< the ray's own, raised to look behind a hit, and lowered to the best one
  WalkCursor cursor;
  bool fresh = true;         ///< has yet to be tested against what has no bounds
  std::uint32_t listed = 0;  ///< treelets in the batch now
  glm::uvec4 treelets{0};    ///< these two as gpu/shaders/stream/ray.glsl has them
  glm::uvec2 entries{0};
  float last_entry = 0;  ///< where it enters the last of them
};

/// The stream tracer's loop (see make_stream_tracer).
class StreamEngine : public DeviceEngine {
 public:
  StreamEngine(std::shared_ptr<const Geometry> geometry, const StreamOptions& options);

  void trace(std::span<const Ray> rays, StreamQuery query, const Arrive& arrive) override;

  const GpuInfo& gpu() const override { return context_.info(); }
  std::size_t batch_rays() const override { return static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_); }
  std::size_t bytes() const override { return textures_.bytes + treelets_.bytes(); }

  /// Of the scene on the device alone.
  std::size_t scene_bytes() const { return textures_.bytes; }
  /// Uploaded and read back so far, for rays.
  std::size_t bytes_carried() const { return bytes_carried_; }

 private:
  /// A query, and how far it has come.
  struct Job {
    std::span<const Ray> rays;
    StreamQuery query;
    const Arrive& arrive;
    std::size_t next = 0;                  ///< the first ray that has not set out
    std::vector<StreamTraveller> again{};  ///< back from the device, to be sent on
  };

  /// A batch, and those who travel in it.
  struct Slot {
    explicit Slot(GLsizei side) : batch(side) {}
    StreamBatch batch;
    std::vector<StreamTraveller> travellers;
    std::size_t old = 0;                ///< those before it have travelled already
    std::size_t first_fresh = 0;        ///< the ray that sets out as traveller `old`
    std::vector<SortKey> order, spare;  ///< who goes to the device, by place in the batch
    std::vector<char> stays;            ///< by traveller: it neither goes nor has its answer
  };

  StreamTraveller set_out(std::uint32_t index, const Ray& ray) const;
  void look_behind(StreamTraveller& traveller, const Ray& ray) const;
  const StreamKernels& kernels(StreamQuery query);
  void fill(Slot& slot, Job& job) const;
  void send(Slot& slot, Job& job);
  void list(StreamTraveller& traveller, std::span<const TreeletEntry> found) const;
  void list_block(std::span<StreamTraveller> travellers, std::span<const Ray> rays) const;
  void prepare_block(Slot& slot, const Job& job, std::size_t first) const;
  void take_places(Slot& slot) const;
  void dispatch(Slot& slot, StreamQuery query);
  static void enter(StreamTraveller& traveller, const StreamBatch::Answer& answer);
  void collect(Slot& slot, Job& job);
  bool arrived(StreamTraveller& traveller, const Job& job) const;
  static bool settled(const StreamTraveller& traveller, StreamQuery query);

  StreamOptions options_;
  Context context_;
  GLsizei side_;
  FlatScene scene_;
  Treelets treelets_;
  std::uint32_t list_length_;  // treelets that rays take along
  SceneTextures textures_;
  std::optional<StreamKernels> closest_, any_;
  std::vector<std::unique_ptr<Slot>> slots_;
  std::size_t bytes_carried_ = 0;
};

}  // namespace rayengine
