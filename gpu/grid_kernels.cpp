#include "gpu/grid_kernels.h"

#include <chrono>

#include "gpu/kernel_program.h"

namespace rayengine {
namespace {

constexpr GLint steps_location = 8;

/// The depth of a state: see gpu/shaders/grid/traverse.glsl.
float depth_of(std::size_t state) { return static_cast<float>(state) / 4; }

Program make_program(std::string_view name, std::string_view main, bool tests, std::vector<std::string> defines) {
  Stage stage{0,
              {"accel/kernels/prelude.glsl", "accel/kernels/box.glsl", "accel/kernels/grid.glsl",
               "accel/kernels/triangle.glsl", "accel/kernels/quadric.glsl", "gpu/shaders/stream/ray.glsl",
               "gpu/shaders/stream/consider.glsl", "gpu/shaders/stream/nearest.glsl", "gpu/shaders/grid/traverse.glsl"},
              std::move(defines)};
  if (tests)
    for (const std::string_view source :
         {"gpu/shaders/stream/triangle.glsl", "gpu/shaders/stream/quadric.glsl", "gpu/shaders/grid/intersect.glsl"})
      stage.sources.push_back(source);
  stage.sources.push_back(main);
  return make_screen_program(name, std::move(stage));
}

std::vector<std::string> defines_of(const std::vector<KernelType>& types, StreamQuery query,
                                    std::vector<std::string> defines) {
  if (query == StreamQuery::any) defines.push_back("ANY_HIT");
  defines.push_back(grid_tests(types));
  return defines;
}

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

GridKernels::GridKernels(const std::vector<KernelType>& types, StreamQuery query,
                         const std::vector<std::string>& defines)
    : defines_(defines_of(types, query, defines)),
      traverse_(make_program("traverse", "gpu/shaders/grid/traverse.frag.glsl", false, defines_)),
      intersect_(make_program("intersect", "gpu/shaders/grid/intersect.frag.glsl", true, defines_)),
      states_(
          make_screen_program("states", {0, {"gpu/shaders/stream/ray.glsl", "gpu/shaders/grid/states.frag.glsl"}, {}})),
      count_(make_screen_program("count", {0, {"gpu/shaders/grid/count.frag.glsl"}, {}})) {
  for (Query& counter : counters_) counter = make_query(GL_SAMPLES_PASSED);
}

void GridKernels::begin(const StreamBatch& batch, const GridTextures& grid) const {
  glBindVertexArray(vertices_.id());
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_SCISSOR_TEST);
  glEnable(GL_DEPTH_TEST);
  batch.bind();
  grid.bind();
}

void GridKernels::end() const {
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_SCISSOR_TEST);
  glDepthMask(GL_TRUE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void GridKernels::use(const Program& program, const GridTextures& grid, const GridPolicy& policy) const {
  program.use();
  grid.set_uniforms();
  glUniform1i(steps_location, static_cast<GLint>(policy.steps));
}

/// One pass over the rays in a state. Each reads and writes its own texels once, which the barrier makes defined.
void GridKernels::draw(GridState state, const GridTextures& grid, const GridPolicy& policy) const {
  use(state == GridState::traverse ? traverse_ : intersect_, grid, policy);
  glDepthFunc(GL_EQUAL);
  glDepthMask(GL_FALSE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  if (state == GridState::traverse) glColorMaski(0, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);  // hits stay as they are
  draw_everywhere(depth_of(static_cast<std::size_t>(state)));
  glTextureBarrier();
}

/// Makes what kernels left in the texels the rays' depths, and counts those in each state.
GridCounts GridKernels::update_states() const {
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  states_.use();
  glDepthFunc(GL_ALWAYS);
  glDepthMask(GL_TRUE);
  draw_everywhere();
  count_.use();
  glDepthFunc(GL_EQUAL);
  glDepthMask(GL_FALSE);
  GridCounts counts{};
  constexpr std::size_t states = 2;
  for (std::size_t i = 0; i < states; ++i) {
    glBeginQuery(GL_SAMPLES_PASSED, counters_[i].id());
    draw_everywhere(depth_of(i));
    glEndQuery(GL_SAMPLES_PASSED);
  }
  for (std::size_t i = 0; i < states; ++i) {
    GLuint64 count = 0;
    glGetQueryObjectui64v(counters_[i].id(), GL_QUERY_RESULT, &count);
    counts[i] = count;
  }
  return counts;
}

void GridKernels::run(const StreamBatch& batch, const GridTextures& grid, const GridPolicy& policy, bool timed) {
  begin(batch, grid);
  GridCounts waiting = update_states();
  while (const auto state = next_kernel(policy, waiting)) {
    const auto i = static_cast<std::size_t>(*state);
    if (timed) glFinish();
    const double start = now();
    draw(*state, grid, policy);
    ++work_.passes[i];
    work_.rays[i] += waiting[i];
    waiting = update_states();
    if (timed) glFinish();
    work_.seconds[i] += now() - start;
  }
  end();
}

void GridKernels::run_single(const StreamBatch& batch, const GridTextures& grid, const GridPolicy& policy) {
  if (!single_) single_.emplace(make_program("grid", "gpu/shaders/grid/single.frag.glsl", true, defines_));
  begin(batch, grid);
  use(*single_, grid, policy);
  glDepthFunc(GL_ALWAYS);
  glDepthMask(GL_FALSE);
  glColorMaski(1, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);  // places stay as they are
  draw_everywhere();
  glTextureBarrier();
  end();
}

}  // namespace rayengine
