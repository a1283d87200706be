#include "gpu/stream_kernels.h"

#include <chrono>

#include "gpu/kernel_program.h"

namespace rayengine {

StreamKernels::StreamKernels(const SceneTextures& scene, StreamQuery query, const std::vector<std::string>& defines) {
  const auto start = std::chrono::steady_clock::now();
  Stage stage{0, {"gpu/shaders/stream/ray.glsl", "gpu/shaders/stream/select.frag.glsl"}, {}};
  if (query == StreamQuery::any) stage.defines.push_back("ANY_HIT");
  std::vector<std::string> all = defines;
  all.insert(all.end(), stage.defines.begin(), stage.defines.end());
  select_.emplace(make_screen_program("select", std::move(stage)));
  for (const KernelType type : scene.types) {
    tests_.push_back(
        make_kernel_program(type, {"gpu/shaders/stream/ray.glsl", "gpu/shaders/stream/nearest.glsl"}, all));
    selected_.push_back(make_query(GL_ANY_SAMPLES_PASSED));
  }
  compile_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Every ray is shaded, and those that stay get the state as their depth.
void StreamKernels::select(const Query& any, float state) const {
  glDepthFunc(GL_ALWAYS);
  glDepthMask(GL_TRUE);
  glBeginQuery(GL_ANY_SAMPLES_PASSED, any.id());
  draw_everywhere(state);
  glEndQuery(GL_ANY_SAMPLES_PASSED);
}

/// Rays in the state are tested. Each reads and writes its own texel of the hits once, which the barrier makes defined.
void StreamKernels::test(const Query& any, float state) const {
  glDepthFunc(GL_EQUAL);
  glDepthMask(GL_FALSE);
  glTextureBarrier();
  glBeginConditionalRender(any.id(), GL_QUERY_NO_WAIT);
  draw_everywhere(state);
  glEndConditionalRender();
  glTextureBarrier();
}

void StreamKernels::run(const StreamBatch& batch, const SceneTextures& scene, std::uint32_t rounds) const {
  glBindVertexArray(vertices_.id());
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_SCISSOR_TEST);
  glEnable(GL_DEPTH_TEST);
  batch.bind();
  scene.ranges.bind(ranges_unit);
  scene.forms.bind(forms_unit);
  const auto place = [&](const Program& program, std::size_t round, std::size_t type) {
    program.use();
    glUniform1i(round_location, static_cast<GLint>(round));
    glUniform1i(type_location, static_cast<GLint>(type));
    glUniform1i(types_location, static_cast<GLint>(tests_.size()));
  };
  for (std::size_t round = 0; round < rounds; ++round)
    for (std::size_t type = 0; type < tests_.size(); ++type) {
      // A state of its own for every pass, so that what earlier passes left in the depth buffer never equals it.
      const float state = static_cast<float>(1 + round * tests_.size() + type) / 64;
      batch.draw_states();
      place(*select_, round, type);
      select(selected_[type], state);
      (scene.types[type] == TreeletPrimitive::triangle ? scene.triangles : scene.quadrics).bind(primitives_unit);
      batch.draw_hits();
      place(tests_[type], round, type);
      test(selected_[type], state);
    }
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_SCISSOR_TEST);
  glDepthMask(GL_TRUE);
}

}  // namespace rayengine
