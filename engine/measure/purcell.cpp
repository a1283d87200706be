#include "engine/measure/purcell.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "engine/render/cast.h"
#include "gpu/grid/grid_caster.h"

namespace rayengine {
namespace {

constexpr std::array<unsigned, 6> resolutions{4, 8, 16, 32, 64, 128};
constexpr std::array<std::uint32_t, 2> step_choices{1, 1024};
constexpr std::array<const char*, grid_state_count> state_names{"traverse", "intersect", "shade"};

struct NamedPolicy {
  const char* name;
  GridPolicy policy;
};
const std::array policies{NamedPolicy{"one after the other", {.rule = GridPolicy::Rule::turns}},
                          NamedPolicy{"as soon as any ray waits", {.rule = GridPolicy::Rule::share, .share = 0}},
                          NamedPolicy{"when a quarter wait", {.rule = GridPolicy::Rule::share, .share = 0.25}},
                          NamedPolicy{"when half wait", {.rule = GridPolicy::Rule::share, .share = 0.5}},
                          NamedPolicy{"when all wait", {.rule = GridPolicy::Rule::share, .share = 1}},
                          NamedPolicy{"what most wait for", {.rule = GridPolicy::Rule::most}}};

unsigned longest(const glm::uvec3& counts) { return std::max({counts.x, counts.y, counts.z}); }

double cost(const CastSeconds& seconds, bool software) { return software ? seconds.processor : seconds.elapsed; }

double total(const GridWork& work, bool software) {
  return std::accumulate(work.watches.begin(), work.watches.end(), 0.,
                         [=](double sum, const CastWatch& watch) { return sum + cost(watch.seconds(), software); });
}

class Experiment {
 public:
  Experiment(const Scene& scene, const PurcellOptions& options)
      : scene_(scene), options_(options), lights_(cast_lights(scene)), materials_(cast_materials(scene)) {
    Camera camera = scene.camera;
    camera.size = options.size;
    view_ = cast_view(camera);
  }

  PurcellFigures run() {
    PurcellFigures figures;
    for (const unsigned resolution : resolutions) measure_resolution(figures, resolution);
    for (const std::uint32_t steps : step_choices)
      for (const NamedPolicy& policy : policies) measure_policy(figures, policy, steps);
    measure_single_pass(figures);
    return figures;
  }

 private:
  std::unique_ptr<GridCaster> caster(const GridTracerOptions& tracer) const {
    return std::make_unique<GridCaster>(scene_.geometry, lights_, materials_, scene_.background.color,
                                        GridCastOptions{tracer, true, 1});
  }

  /// Voxels for each primitive at which the longest axis has `resolution`.
  double density(unsigned resolution) const {
    const glm::dvec3 size = scene_.geometry->bounds.size();
    const double side = std::max({size.x, size.y, size.z}) / resolution;
    double voxels = 1;
    for (int i = 0; i < 3; ++i) voxels *= std::max(size[i] / side, 1.);
    return voxels / scene_.geometry->primitive_count;
  }

  /// The fastest of some pictures after one that warms up.
  GridWork measure(GridCaster& caster) {
    caster.measure(view_);
    GridWork best = caster.measure(view_);
    for (int i = 1; i < options_.runs; ++i) {
      const GridWork work = caster.measure(view_);
      if (total(work, caster.gpu().software) < total(best, caster.gpu().software)) best = work;
    }
    if (options_.progress)
      options_.progress(++done_ / (resolutions.size() + step_choices.size() * policies.size() + 1.));
    return best;
  }

  void measure_resolution(PurcellFigures& figures, unsigned resolution) {
    const auto grid = caster({.device = options_.gpu,
                              .grid = {.density = density(resolution)},
                              .policy = GridPolicy{.rule = GridPolicy::Rule::most, .steps = 1}});
    const GridWork work = measure(*grid);
    for (std::size_t i = 0; i < grid_state_count; ++i)
      figures.rows.push_back({longest(grid->resolution()), state_names[i], work.passes[i],
                              1e3 * cost(work.watches[i].seconds(), grid->gpu().software)});
  }

  void measure_policy(PurcellFigures& figures, const NamedPolicy& named, std::uint32_t steps) {
    GridPolicy policy = named.policy;
    policy.steps = steps;
    const auto grid = caster({.device = options_.gpu, .policy = policy});
    const GridWork work = measure(*grid);
    const auto passes = std::accumulate(work.passes.begin(), work.passes.end(), std::size_t{0});
    figures.policies.push_back({named.name, steps, passes, 1e3 * fastest(*grid)});
    figures.usual_resolution = longest(grid->resolution());
    figures.device = grid->gpu().renderer;
    figures.software = grid->gpu().software;
  }

  void measure_single_pass(PurcellFigures& figures) {
    const auto grid = caster({.device = options_.gpu, .policy = GridPolicy{.few = 1}});
    grid->measure(view_);
    figures.policies.push_back({"all in one shader", GridPolicy{}.steps, 1, 1e3 * fastest(*grid)});
  }

  /// A picture whose kernels are not waited for.
  double fastest(GridCaster& caster) const {
    double best = infinity;
    for (int i = 0; i < options_.runs; ++i) best = std::min(best, cost(caster.time(view_), caster.gpu().software));
    return best;
  }

  const Scene& scene_;
  const PurcellOptions& options_;
  std::vector<CastLight> lights_;
  std::vector<CastMaterial> materials_;
  CastView view_;
  std::size_t done_ = 0;
};

}  // namespace

PurcellFigures purcell(const Scene& scene, const PurcellOptions& options) { return Experiment(scene, options).run(); }

}  // namespace rayengine
