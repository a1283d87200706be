#include "gpu/stream/stream_kernels.h"

#include <algorithm>

#include "gpu/scene/kernel_program.h"

namespace rayengine {
namespace {

/// Depths: of rays that are not done, rising from pass to pass, and of those that are.
constexpr float state_count = 64;
static_assert(1 + longest_list * (quadric_type_count + 1) < state_count);

}  // namespace

StreamKernels::StreamKernels(const SceneTextures& scene, StreamQuery query, const std::vector<std::string>& defines) {
  std::vector<std::string> all = defines;
  if (query == StreamQuery::any) all.push_back("ANY_HIT");
  const std::string_view ray = "gpu/shaders/stream/ray.glsl";
  settle_.emplace(make_screen_program("settle", {0, {ray, "gpu/shaders/stream/settle.frag.glsl"}, all}));
  select_.emplace(make_screen_program("select", {0, {ray, "gpu/shaders/stream/select.frag.glsl"}, all}));
  for (const KernelType type : scene.types)
    tests_.push_back(
        make_kernel_program(type, {ray, "gpu/shaders/stream/consider.glsl", "gpu/shaders/stream/nearest.glsl"}, all));
  for (Query& query : tested_) query = make_query(GL_ANY_SAMPLES_PASSED);
}

bool StreamKernels::cached() const {
  const auto cached = [](const Program& program) { return program.cached(); };
  return settle_->cached() && select_->cached() && std::all_of(tests_.begin(), tests_.end(), cached);
}

void StreamKernels::use(const Program& program, std::uint32_t round, std::size_t type) const {
  program.use();
  glUniform1i(round_location, static_cast<GLint>(round));
  glUniform1i(type_location, static_cast<GLint>(type));
  glUniform1i(types_location, static_cast<GLint>(tests_.size()));
}

/// Draws states: the depths of the rays that the program does not discard. Rays that are done are not asked.
void StreamKernels::draw_states(float state) const {
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_TRUE);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  draw_everywhere(state);
}

/// Rays in the state are tested. Each reads and writes its own texel of the hits once, which the barrier makes defined.
void StreamKernels::test(std::uint32_t round, std::size_t type, float state) const {
  use(tests_[type], round, type);
  glDepthFunc(GL_EQUAL);
  glDepthMask(GL_FALSE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  draw_everywhere(state);
  glTextureBarrier();
}

/// Where there is one type all rays that are not done are in one state; else those that have primitives of the type in
/// their treelet get a state of its own, above those before it.
void StreamKernels::test_types(std::uint32_t round) const {
  for (std::size_t type = 0; type < tests_.size(); ++type) {
    float state = state_start;
    if (tests_.size() > 1) {
      state = static_cast<float>(1 + round * tests_.size() + type) / state_count;
      use(*select_, round, type);
      draw_states(state);
    }
    test(round, type, state);
  }
}

void StreamKernels::run(const StreamBatch& batch, const SceneTextures& scene, std::uint32_t rounds) const {
  glBindVertexArray(vertices_.id());
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_SCISSOR_TEST);
  glEnable(GL_DEPTH_TEST);
  batch.bind();
  scene.ranges.bind(ranges_unit);
  scene.bind();
  for (std::uint32_t round = 0; round < rounds; ++round) {
    if (round > 0) {
      glBeginConditionalRender(tested_[round - 1].id(), GL_QUERY_NO_WAIT);
      use(*settle_, round, 0);
      draw_states(state_done);
    }
    glBeginQuery(GL_ANY_SAMPLES_PASSED, tested_[round].id());
    test_types(round);
    glEndQuery(GL_ANY_SAMPLES_PASSED);
    if (round > 0) glEndConditionalRender();
  }
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_SCISSOR_TEST);
  glDepthMask(GL_TRUE);
}

}  // namespace rayengine
