#include "gpu/grid/grid_kernels.h"

#include <numeric>

#include "gpu/scene/kernel_program.h"

namespace rayengine {
namespace {

constexpr GLint steps_location = 8;

/// The depth of a state: see gpu/shaders/grid/traverse.glsl.
float depth_of(std::size_t state) { return static_cast<float>(state) / 4; }

/// Writes only the targets whose bits are set.
void write_targets(unsigned bits) {
  for (GLuint target = 0; target <= GridKernels::weights_target; ++target) {
    const GLboolean on = bits >> target & 1 ? GL_TRUE : GL_FALSE;
    glColorMaski(target, on, on, on, on);
  }
}
constexpr unsigned bit(GridKernels::Target target) { return 1u << target; }
constexpr unsigned all_targets = ~0u;

std::size_t result(const Query& query) {
  GLuint64 count = 0;
  glGetQueryObjectui64v(query.id(), GL_QUERY_RESULT, &count);
  return count;
}

}  // namespace

GridKernels::GridKernels(const std::vector<KernelType>& types, StreamQuery query, std::vector<std::string> defines,
                         Shading shading)
    : shading_(std::move(shading)),
      defines_([&] {
        if (query == StreamQuery::any) defines.push_back("ANY_HIT");
        if (shaded()) defines.push_back("SHADED");
        defines.push_back(grid_tests(types));
        defines.push_back(grid_normals(types));
        return defines;
      }()),
      traverse_(make_program("traverse", "gpu/shaders/grid/traverse.frag.glsl", false)),
      intersect_(make_program("intersect", "gpu/shaders/grid/intersect.frag.glsl", true)),
      states_(
          make_screen_program("states", {0, {"gpu/shaders/stream/ray.glsl", "gpu/shaders/grid/states.frag.glsl"}, {}})),
      count_(make_screen_program("count", {0, {"gpu/shaders/grid/count.frag.glsl"}, {}})) {
  if (shaded()) shade_.emplace(make_program("shade", "gpu/shaders/grid/shade.frag.glsl", true));
  for (Query& counter : counters_) counter = make_query(GL_SAMPLES_PASSED);
}

Program GridKernels::make_program(std::string_view name, std::string_view main, bool tests) const {
  Stage stage{
      0,
      {"accel/kernels/prelude.glsl", "accel/kernels/box.glsl", "accel/kernels/grid.glsl", "accel/kernels/triangle.glsl",
       "accel/kernels/quadric.glsl", "gpu/shaders/stream/ray.glsl", "gpu/shaders/stream/consider.glsl",
       "gpu/shaders/stream/nearest.glsl", "gpu/shaders/grid/traverse.glsl", "gpu/shaders/grid/place.glsl"},
      defines_};
  if (tests) {
    for (const std::string_view source :
         {"gpu/shaders/stream/triangle.glsl", "gpu/shaders/stream/quadric.glsl", "gpu/shaders/grid/intersect.glsl"})
      stage.sources.push_back(source);
    stage.sources.insert(stage.sources.end(), shading_.sources.begin(), shading_.sources.end());
    if (shaded()) stage.sources.push_back("gpu/shaders/grid/shade.glsl");
  }
  stage.sources.push_back(main);
  return make_screen_program(name, std::move(stage));
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

/// One pass over the rays in a state, which it counts. Each reads and writes its own texels once, which the barrier
/// makes defined.
std::size_t GridKernels::draw(GridState state, const GridTextures& grid, const GridPolicy& policy) const {
  constexpr std::array written{bit(places_target), bit(places_target) | bit(hits_target), all_targets};
  const std::array programs{&traverse_, &intersect_, shade_ ? &*shade_ : nullptr};
  const auto i = static_cast<std::size_t>(state);
  use(*programs[i], grid, policy);
  if (state == GridState::shade) shading_.set_uniforms();
  glDepthFunc(GL_EQUAL);
  glDepthMask(GL_FALSE);
  write_targets(written[i]);
  glBeginQuery(GL_SAMPLES_PASSED, counters_[i].id());
  draw_everywhere(depth_of(i));
  glEndQuery(GL_SAMPLES_PASSED);
  glTextureBarrier();
  return result(counters_[i]);
}

/// Makes what kernels left in the texels the rays' depths.
void GridKernels::update_states() const {
  write_targets(0);
  states_.use();
  glDepthFunc(GL_ALWAYS);
  glDepthMask(GL_TRUE);
  draw_everywhere();
}

GridCounts GridKernels::count_states() const {
  write_targets(0);
  count_.use();
  glDepthFunc(GL_EQUAL);
  glDepthMask(GL_FALSE);
  for (std::size_t i = 0; i < states(); ++i) {
    glBeginQuery(GL_SAMPLES_PASSED, counters_[i].id());
    draw_everywhere(depth_of(i));
    glEndQuery(GL_SAMPLES_PASSED);
  }
  GridCounts counts{};
  for (std::size_t i = 0; i < states(); ++i) counts[i] = result(counters_[i]);
  return counts;
}

/// Runs one kernel after the other, until each has found that no ray waits for it, or that so few do that a loop ends
/// their ways sooner.
GridWork GridKernels::run_by_turns(const GridTextures& grid, const GridPolicy& policy, std::size_t few, bool timed) {
  GridWork work;
  GridCounts ran{};  // for so many rays in the last pass of each state; no more are under way
  for (std::size_t i = 0, pass = 1;; i = (i + 1) % states(), ++pass) {
    ran[i] = run_kernel(static_cast<GridState>(i), grid, policy, timed, work);
    const std::size_t under_way = std::accumulate(ran.begin(), ran.end(), std::size_t{0});
    if (pass < states() || under_way > few) continue;
    if (under_way > 0) draw_single(grid, policy);
    return work;
  }
}

GridWork GridKernels::run_by_counts(const GridTextures& grid, const GridPolicy& policy, bool timed) const {
  GridWork work;
  while (const auto state = next_kernel(policy, count_states())) run_kernel(*state, grid, policy, timed, work);
  return work;
}

std::size_t GridKernels::run_kernel(GridState state, const GridTextures& grid, const GridPolicy& policy, bool timed,
                                    GridWork& work) const {
  const auto i = static_cast<std::size_t>(state);
  if (timed) work.watches[i].start();
  const std::size_t rays = draw(state, grid, policy);
  if (rays > 0) update_states();
  if (timed) work.watches[i].stop();
  ++work.passes[i];
  work.rays[i] += rays;
  return rays;
}

GridWork GridKernels::run(const StreamBatch& batch, const GridTextures& grid, const GridPolicy& policy, bool timed) {
  const bool none = policy.rule == GridPolicy::Rule::turns && policy.few >= 1;
  GridWork work;
  begin(batch, grid);
  if (none)
    draw_single(grid, policy);
  else
    work = run_passes(grid, policy, batch.capacity(), timed);
  end();
  return work;
}

GridWork GridKernels::run_passes(const GridTextures& grid, const GridPolicy& policy, std::size_t capacity, bool timed) {
  update_states();
  if (policy.rule != GridPolicy::Rule::turns) return run_by_counts(grid, policy, timed);
  return run_by_turns(grid, policy, static_cast<std::size_t>(policy.few * static_cast<double>(capacity)), timed);
}

/// A pass in which all rays go all their ways, from wherever they are.
void GridKernels::draw_single(const GridTextures& grid, const GridPolicy& policy) {
  if (!single_) single_.emplace(make_program("grid", "gpu/shaders/grid/single.frag.glsl", true));
  use(*single_, grid, policy);
  if (shaded()) shading_.set_uniforms();
  glDepthFunc(GL_ALWAYS);
  glDepthMask(GL_FALSE);
  write_targets(bit(hits_target) | bit(gathered_target));
  draw_everywhere();
  glTextureBarrier();
}

}  // namespace rayengine
