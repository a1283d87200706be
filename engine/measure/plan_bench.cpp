#include "engine/measure/plan_bench.h"

#include <algorithm>
#include <vector>

#include "engine/measure/race.h"
#include "engine/render/render.h"
#include "engine/tracers.h"

namespace rayengine {
namespace {

PictureCost picture(const Scene& scene, const std::string& name, const TracerOptions& options) {
  const auto tracer = make_tracer(name, scene.geometry, options);
  const RenderResult result = render(scene, *tracer, {.threads = options.threads});
  return {0, tracer->build_seconds(), result.stats.seconds, scene.geometry->bytes() + tracer->bytes()};
}

double median_of(const std::vector<PictureCost>& costs, double PictureCost::*part) {
  std::vector<double> values;
  for (const PictureCost& c : costs) values.push_back(c.*part);
  std::ranges::sort(values);
  return quantile(values, 0.5);
}

PictureCost median(const std::vector<PictureCost>& costs) {
  return {median_of(costs, &PictureCost::planning), median_of(costs, &PictureCost::build),
          median_of(costs, &PictureCost::render), costs.back().bytes};
}

}  // namespace

PlanBench bench_plan(const Scene& scene, const PlanOptions& options, int threads,
                     const std::function<void(double share)>& progress) {
  std::vector<PictureCost> without, with;
  PlanBench result;
  for (int run = 0; run <= timed_runs; ++run) {
    const PictureCost plain = picture(scene, "auto", {.threads = threads});
    const Planned planned = plan_scene(scene, options);
    const TracingPlan& tracing = planned.tracing;
    TracerOptions chosen = options_of(tracing);
    chosen.threads = threads;
    PictureCost cost = picture(planned.model.scene, tracing.tracer, chosen);
    cost.planning = planned.seconds;
    result.replaced = planned.model.replaced.size();
    if (run > 0) without.push_back(plain), with.push_back(cost);
    if (progress) progress(static_cast<double>(run + 1) / (timed_runs + 1));
  }
  result.without = median(without);
  result.with = median(with);
  return result;
}

}  // namespace rayengine
