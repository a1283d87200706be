#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "accel/walk.h"
#include "gpu/context.h"
#include "gpu/frame_ray.h"
#include "gpu/stream_kernels.h"
#include "gpu/stream_tracer.h"

namespace rayengine {

/// A ray under way: what the CPU keeps of it between batches.
struct Traveller {
  std::uint32_t ray = 0;  ///< index into the caller's rays
  FrameRay frame;
  Ray world;  ///< the caller's, with tmax lowered to the best hit
  WalkCursor cursor;
  bool fresh = true;         ///< has yet to be tested against what has no bounds
  std::uint32_t listed = 0;  ///< treelets in the batch now
  float last_entry = 0;      ///< where it enters the last of them
  float best_t = 0;          ///< in the frame; counts when best_rank is not no_id
  std::uint32_t best_rank = no_id;
  std::uint32_t floor_rank = no_id;  ///< hits at tmin count if their rank is above this
};

/// The device's side of the stream tracer, and its loop. Lives on the thread of its context.
class StreamEngine {
 public:
  StreamEngine(std::shared_ptr<const Geometry> geometry, const StreamOptions& options);

  /// What becomes of a traveller that has its answer.
  enum class Next { done, again };
  using Arrive = std::function<Next(Traveller&)>;

  /// Sends all valid rays, and calls `arrive` with each that has its answer, from several threads. One that is sent
  /// again, after pass(), comes back with its next answer.
  void trace(std::span<const Ray> rays, StreamQuery query, const Arrive& arrive);

  /// Lets a traveller look behind its best hit, as if that were not there.
  void pass(Traveller& traveller, const Ray& ray) const;

  const GpuInfo& gpu() const { return context_.info(); }
  std::size_t batch_rays() const { return static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_); }
  std::size_t bytes() const { return textures_.bytes + treelets_.bytes(); }

 private:
  /// A batch, and those who travel in it.
  struct Slot {
    explicit Slot(GLsizei side) : batch(side) {}
    StreamBatch batch;
    std::vector<Traveller> travellers;
  };

  Traveller set_out(std::uint32_t index, const Ray& ray) const;
  const StreamKernels& kernels(StreamQuery query);
  void send(Slot& slot, StreamQuery query);
  std::uint32_t list_treelets(Slot& slot);
  std::uint32_t list_block(Slot& slot, std::size_t first, std::size_t count) const;
  void write(const StreamBatch& batch, std::size_t i, Traveller& traveller, std::span<const TreeletEntry> list) const;
  void collect(Slot& slot, StreamQuery query, const Arrive& arrive, std::vector<Traveller>& again);
  bool settled(const Traveller& traveller, StreamQuery query) const;

  StreamOptions options_;
  Context context_;
  GLsizei side_;
  FlatScene scene_;
  Treelets treelets_;
  SceneTextures textures_;
  std::optional<StreamKernels> closest_, any_;
  std::vector<std::unique_ptr<Slot>> slots_;
};

}  // namespace rayengine
