#include "engine/measure/purcell.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "accel/stopwatch.h"
#include "engine/render/cast.h"
#include "gpu/grid_caster.h"

namespace rayengine {
namespace {

constexpr std::array<unsigned, 6> resolutions{4, 8, 16, 32, 64, 128};
constexpr std::array<std::uint32_t, 4> step_choices{1, 4, 16, 1024};
constexpr std::array<const char*, grid_state_count> state_names{"traverse", "intersect", "shade"};

struct NamedPolicy {
  const char* name;
  GridPolicy policy;
};
const std::array policies{NamedPolicy{"as soon as any ray waits", {.share = 0}},
                          NamedPolicy{"when a tenth wait", {.share = 0.1}},
                          NamedPolicy{"when a quarter wait", {.share = 0.25}},
                          NamedPolicy{"when half wait", {.share = 0.5}},
                          NamedPolicy{"when three quarters wait", {.share = 0.75}},
                          NamedPolicy{"when all wait", {.share = 1}},
                          NamedPolicy{"what most wait for", {.rule = GridPolicy::Rule::most}}};

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

double total(const GridWork& work) { return std::accumulate(work.seconds.begin(), work.seconds.end(), 0.); }

class Experiment {
 public:
  Experiment(const Scene& scene, const PurcellOptions& options)
      : scene_(scene), options_(options), lights_(cast_lights(scene)), materials_(cast_materials(scene)) {
    Camera camera = scene.camera;
    camera.size = {options.side, options.side};
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

  /// Pictures after one that warms up.
  std::vector<GridWork> measure(GridCaster& caster) {
    caster.measure(view_);
    std::vector<GridWork> works;
    for (int i = 0; i < options_.runs; ++i) works.push_back(caster.measure(view_));
    if (options_.progress)
      options_.progress(++done_ / (resolutions.size() + step_choices.size() * policies.size() + 1.));
    return works;
  }

  void measure_resolution(PurcellFigures& figures, unsigned resolution) {
    const auto grid =
        caster({.device = options_.gpu, .grid = {.density = density(resolution)}, .policy = {.steps = 1}});
    const std::vector<GridWork> works = measure(*grid);
    const glm::uvec3 counts = grid->resolution();
    for (std::size_t i = 0; i < grid_state_count; ++i) {
      std::vector<double> seconds;
      for (const GridWork& work : works) seconds.push_back(work.seconds[i]);
      figures.rows.push_back(
          {std::max({counts.x, counts.y, counts.z}), state_names[i], works[0].passes[i], 1e3 * median(seconds)});
    }
  }

  void measure_policy(PurcellFigures& figures, const NamedPolicy& named, std::uint32_t steps) {
    GridPolicy policy = named.policy;
    policy.steps = steps;
    const auto grid = caster({.device = options_.gpu, .policy = policy});
    const std::vector<GridWork> works = measure(*grid);
    std::vector<double> seconds;
    for (const GridWork& work : works) seconds.push_back(total(work));
    const auto& passes = works[0].passes;
    figures.policies.push_back(
        {named.name, steps, std::accumulate(passes.begin(), passes.end(), std::size_t{0}), 1e3 * median(seconds)});
    const glm::uvec3 counts = grid->resolution();
    figures.usual_resolution = std::max({counts.x, counts.y, counts.z});
    figures.device = grid->device();
  }

  void measure_single_pass(PurcellFigures& figures) {
    const auto grid = caster({.device = options_.gpu, .single_pass = true});
    grid->measure(view_);
    std::vector<double> seconds;
    for (int i = 0; i < options_.runs; ++i) {
      const Stopwatch watch;
      grid->measure(view_);
      seconds.push_back(watch.seconds());
    }
    figures.policies.push_back({"all in one shader", GridPolicy{}.steps, 1, 1e3 * median(seconds)});
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
