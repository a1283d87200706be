#include "gpu/stream_kernels.h"

#include <chrono>
#include <cstdio>

namespace rayengine {
namespace {

/// Locations in gpu/shaders/stream/ray.glsl.
enum : GLint { round_location = 1, type_location = 2, types_location = 3 };
enum : GLuint { ranges_unit = 5, primitives_unit = 6, forms_unit = 7 };

std::string form_define(QuadricType type) {
  const QuadricMatrix m = unit_matrix(type);
  char text[120];
  std::snprintf(text, sizeof text, "FORM=%.1f, %.1f, %.1f, %.1f, %.1f", m[0], m[4], m[7], m[8], m[9]);
  return text;
}

std::vector<std::string> quadric_defines(QuadricType type) {
  switch (type) {
    case QuadricType::general: return {"GENERAL"};
    case QuadricType::plane: return {"PLANE", form_define(type)};
    case QuadricType::disk: return {"DISK", form_define(type)};
    case QuadricType::saddle: return {"SADDLE", form_define(type)};
    case QuadricType::sphere: return {form_define(type)};
    case QuadricType::cone: return {"CAPS", "CONE", form_define(type)};
    default: return {"CAPS", form_define(type)};
  }
}

Program make_kernel(KernelType type, StreamQuery query, const std::vector<std::string>& defines) {
  const bool triangle = type == TreeletPrimitive::triangle;
  Stage stage{0, {"accel/kernels/prelude.glsl"}, defines};
  stage.sources.push_back(triangle ? "accel/kernels/triangle.glsl" : "accel/kernels/quadric.glsl");
  stage.sources.insert(stage.sources.end(), {"gpu/shaders/stream/ray.glsl", "gpu/shaders/stream/nearest.glsl"});
  stage.sources.push_back(triangle ? "gpu/shaders/stream/triangle.frag.glsl" : "gpu/shaders/stream/quadric.frag.glsl");
  if (query == StreamQuery::any) stage.defines.push_back("ANY_HIT");
  if (triangle) return make_screen_program("triangle", std::move(stage));
  const auto quadric = static_cast<QuadricType>(type);
  for (std::string& define : quadric_defines(quadric)) stage.defines.push_back(std::move(define));
  return make_screen_program(to_string(quadric), std::move(stage));
}

}  // namespace

StreamKernels::StreamKernels(const SceneTextures& scene, StreamQuery query, const std::vector<std::string>& defines) {
  const auto start = std::chrono::steady_clock::now();
  Stage stage{0, {"gpu/shaders/stream/ray.glsl", "gpu/shaders/stream/select.frag.glsl"}, {}};
  if (query == StreamQuery::any) stage.defines.push_back("ANY_HIT");
  select_.emplace(make_screen_program("select", std::move(stage)));
  for (const KernelType type : scene.types) {
    tests_.push_back(make_kernel(type, query, defines));
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
