#include "engine/plan/planned.h"

#include "accel/stopwatch.h"
#include "engine/plan/canonical.h"

namespace rayengine {

TracerOptions options_of(const TracingPlan& plan) {
  return {.precision = plan.precision, .build = plan.build, .treelet = plan.treelet};
}

Planned plan_scene(const Scene& scene, const PlanOptions& options) {
  const Stopwatch watch;
  const DeviceMeasurements& device = options.device ? *options.device : usual_device();
  const CanonicalScene canonical = in_canonical_forms(scene, options.tolerance);
  const SceneStatistics given = gather_statistics(canonical.scene, options.rays, options.coherent);
  const ModelPlan model = plan_model(given, device, options.tolerance, options.effort);
  Planned result{make_model(canonical.scene, model, options.tools), {}, canonical.choices, 0};
  result.choices.insert(result.choices.end(), model.choices.begin(), model.choices.end());
  const auto trace = [&](const SceneStatistics& made) {
    return plan_tracing(made, device, options.tolerance, options.gpu, !result.model.replaced.empty());
  };
  result.tracing = result.model.replaced.empty()
                       ? trace(given)
                       : trace(gather_statistics(result.model.scene, options.rays, options.coherent));
  result.choices.insert(result.choices.end(), result.tracing.choices.begin(), result.tracing.choices.end());
  result.seconds = watch.seconds();
  return result;
}

}  // namespace rayengine
