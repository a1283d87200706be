#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gpu/cast_watch.h"
#include "gpu/device/program.h"
#include "gpu/device_engine.h"
#include "gpu/grid/grid_policy.h"
#include "gpu/grid/grid_textures.h"
#include "gpu/stream/stream_batch.h"

namespace rayengine {

/// What the kernels of a grid tracer did, by state.
struct GridWork {
  std::array<std::size_t, grid_state_count> passes{};
  std::array<std::size_t, grid_state_count> rays{};  ///< that the passes were for
  std::array<CastWatch, grid_state_count> watches;   ///< with the passes' own upkeep of states; only where timed
};

/// The passes that take a batch through the grid. Each ray's state is a depth; a kernel draws under an EQUAL depth
/// test, so that only rays in its state are shaded; then states are brought up to date. An occlusion query counts the
/// rays that the kernel ran for, others those that wait in each state, from which a policy chooses the next kernel.
class GridKernels {
 public:
  /// What passes write, as their targets in this order; the batch's frame must have those that it needs: the first two,
  /// and all where rays are shaded.
  enum Target : GLuint {
    hits_target,
    places_target,
    origins_target,
    directions_target,
    gathered_target,
    weights_target
  };
  /// The input of a StreamBatch that says where rays are.
  static constexpr std::size_t places_input = 2;

  /// What else shaded rays need.
  struct Shading {
    std::vector<std::string_view> sources;  ///< before gpu/shaders/grid/shade.glsl
    std::function<void()> set_uniforms;     ///< of a program in use
  };

  GridKernels(const std::vector<KernelType>& types, StreamQuery query, std::vector<std::string> defines,
              Shading shading = {});

  /// Runs passes until no ray waits, or a loop over all of a ray's way, as `policy` has it. `timed` waits for the
  /// device after each pass.
  GridWork run(const StreamBatch& batch, const GridTextures& grid, const GridPolicy& policy, bool timed = false);

 private:
  bool shaded() const { return !shading_.sources.empty(); }
  Program make_program(std::string_view name, std::string_view main, bool tests) const;
  void begin(const StreamBatch& batch, const GridTextures& grid) const;
  void end() const;
  void use(const Program& program, const GridTextures& grid, const GridPolicy& policy) const;
  std::size_t draw(GridState state, const GridTextures& grid, const GridPolicy& policy) const;
  void update_states() const;
  GridCounts count_states() const;
  std::size_t states() const { return shaded() ? 3 : 2; }
  std::size_t run_kernel(GridState state, const GridTextures& grid, const GridPolicy& policy, bool timed,
                         GridWork& work) const;
  GridWork run_passes(const GridTextures& grid, const GridPolicy& policy, std::size_t capacity, bool timed);
  GridWork run_by_turns(const GridTextures& grid, const GridPolicy& policy, std::size_t few, bool timed);
  void draw_single(const GridTextures& grid, const GridPolicy& policy);
  GridWork run_by_counts(const GridTextures& grid, const GridPolicy& policy, bool timed) const;

  Shading shading_;
  std::vector<std::string> defines_;
  Program traverse_, intersect_;
  std::optional<Program> shade_, single_;
  Program states_, count_;
  std::array<Query, grid_state_count> counters_;
  VertexArray vertices_ = make_vertex_array();
};

}  // namespace rayengine
