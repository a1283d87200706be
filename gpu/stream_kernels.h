#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gpu/device_engine.h"
#include "gpu/program.h"
#include "gpu/scene_textures.h"
#include "gpu/stream_batch.h"

namespace rayengine {

/// The passes that answer a batch: for each place in the rays' lists and each type of primitive, one that selects the
/// rays in that state by depth, and one that tests them under an EQUAL depth test.
class StreamKernels {
 public:
  /// Compiles the shaders that the types need. `defines` are added to each kernel: the tests' way to break one.
  StreamKernels(const SceneTextures& scene, StreamQuery query, const std::vector<std::string>& defines);

  /// Issues every pass for rays whose lists have up to `rounds` treelets; nothing here waits for the device. Tests that
  /// no ray needs are skipped where the device knows by then.
  void run(const StreamBatch& batch, const SceneTextures& scene, std::uint32_t rounds) const;

  /// Seconds that compiling took; little when the programs came from the cache.
  double compile_seconds() const { return compile_seconds_; }

 private:
  void select(const Query& any, float state) const;
  void test(const Query& any, float state) const;

  double compile_seconds_ = 0;
  std::optional<Program> select_;
  std::vector<Program> tests_;   // by type
  std::vector<Query> selected_;  // by type: whether any ray was
  VertexArray vertices_ = make_vertex_array();
};

}  // namespace rayengine
