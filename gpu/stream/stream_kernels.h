#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "gpu/device/program.h"
#include "gpu/device_engine.h"
#include "gpu/scene/scene_textures.h"
#include "gpu/stream/stream_batch.h"

namespace rayengine {

/// The passes that answer a batch. Each ray's state is a depth: done, or not. For each place in the rays' lists, one
/// pass finds those that are done now; then, for each type of primitive, one selects the rays in that state (unless
/// there is only one type), and one tests them under an EQUAL depth test.
class StreamKernels {
 public:
  /// Compiles the shaders that the types need. `defines` are added to each kernel: the tests' way to break one.
  StreamKernels(const SceneTextures& scene, StreamQuery query, const std::vector<std::string>& defines);

  /// Issues every pass for rays whose lists have up to `rounds` treelets, the first of which all of them have; nothing
  /// here waits for the device. Occlusion queries count the rays that are left, and spare the passes for none where the
  /// device knows by then.
  void run(const StreamBatch& batch, const SceneTextures& scene, std::uint32_t rounds) const;

  /// Whether all programs came from the cache of an earlier run.
  bool cached() const;

 private:
  void use(const Program& program, std::uint32_t round, std::size_t type) const;
  void draw_states(float state) const;
  void test(std::uint32_t round, std::size_t type, float state) const;
  void test_types(std::uint32_t round) const;

  std::optional<Program> settle_, select_;
  std::vector<Program> tests_;              // by type
  std::array<Query, longest_list> tested_;  // by place in the lists: whether any ray was
  VertexArray vertices_ = make_vertex_array();
};

}  // namespace rayengine
