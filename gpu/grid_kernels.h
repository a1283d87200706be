#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gpu/device_engine.h"
#include "gpu/grid_policy.h"
#include "gpu/grid_textures.h"
#include "gpu/program.h"
#include "gpu/stream_batch.h"

namespace rayengine {

/// What the kernels of a grid tracer did, by state.
struct GridWork {
  std::array<std::size_t, grid_state_count> passes{};
  std::array<std::size_t, grid_state_count> rays{};  ///< that the passes were for
  std::array<double, grid_state_count> seconds{};    ///< with the passes' own upkeep of states; only where timed
};

/// The passes that take a batch through the grid. Each ray's state is a depth; a kernel draws under an EQUAL depth
/// test, so that only rays in its state are shaded; then states are brought up to date, and occlusion queries count the
/// rays in each, from which a policy chooses the next kernel. Rays are in a StreamBatch whose lists are written.
class GridKernels {
 public:
  /// Texture of a StreamBatch's inputs that passes write: where rays are.
  static constexpr std::size_t places_input = 2;

  GridKernels(const std::vector<KernelType>& types, StreamQuery query, const std::vector<std::string>& defines);

  /// Runs passes until no ray waits. `timed` waits for the device after each.
  void run(const StreamBatch& batch, const GridTextures& grid, const GridPolicy& policy, bool timed);
  /// The same in one pass, with a loop over all of a ray's way.
  void run_single(const StreamBatch& batch, const GridTextures& grid, const GridPolicy& policy);

  const GridWork& work() const { return work_; }

 private:
  void begin(const StreamBatch& batch, const GridTextures& grid) const;
  void end() const;
  void use(const Program& program, const GridTextures& grid, const GridPolicy& policy) const;
  void draw(GridState state, const GridTextures& grid, const GridPolicy& policy) const;
  GridCounts update_states() const;

  std::vector<std::string> defines_;
  std::vector<KernelType> types_;
  Program traverse_, intersect_, states_, count_;
  std::optional<Program> single_;
  std::array<Query, grid_state_count> counters_;
  VertexArray vertices_ = make_vertex_array();
  GridWork work_;
};

}  // namespace rayengine
