#pragma once

#include "engine/plan/model.h"
#include "engine/plan/plan.h"
#include "engine/tracers.h"

namespace rayengine {

struct PlanOptions {
  Tolerance tolerance;
  double rays = 0;       ///< that will be asked for, about: see expected_rays()
  bool coherent = true;  ///< whether most of them are the eye's or go to lights
  Effort effort;
  bool gpu = false;  ///< whether there is one that is more than software
  MeshTools tools;
  const DeviceMeasurements* device = nullptr;  ///< null: usual_device()
};

/// A scene made ready for a tolerance: what is to be traced, by what, and why.
struct Planned {
  Model model;
  TracingPlan tracing;
  std::vector<Choice> choices;  ///< of the model and of the tracing
  double seconds = 0;           ///< that planning took, the making of the model included
};

/// To make the tracer that a plan chose.
TracerOptions options_of(const TracingPlan& plan);

/// Plans the model, makes it, and plans its tracing. Throws Error on a tolerance that is negative or not a number.
Planned plan_scene(const Scene& scene, const PlanOptions& options);

}  // namespace rayengine
