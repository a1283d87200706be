#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/plan/planned.h"
#include "engine/plan/verify.h"
#include "examples/cli/cli.h"
#include "examples/cli/report.h"

// What the commands that take a tolerance share.
namespace rayengine::cli {

/// What is asked of a plan.
struct PlanningOptions {
  Tolerance::Unit unit = Tolerance::Unit::pixels;
  std::optional<double> tolerance;
  int verify = 0;  ///< rays of the sample; 0: not
  Effort effort;
};

/// `--tolerance`, `--recognise`.
void add_tolerance(CLI::App* app, PlanningOptions& options);
/// These, and `--verify`.
void add_planning(CLI::App* app, PlanningOptions& options);

/// What a plan is made with here: the loader's tools, and the machine as `rayengine plan --measure` found it.
class PlanSource {
 public:
  PlanSource(const PlanningOptions& options, const Common& common);
  PlanOptions for_rays(double rays, bool coherent) const;

 private:
  PlanOptions options_;
  DeviceMeasurements device_;
};

/// A scene, ready to be traced: as it is, or as a plan made it.
class PlannedScene {
 public:
  /// Plans where a tolerance was given. What the plan does not need of the scene is let go.
  PlannedScene(const PlanningOptions& options, Scene scene, double rays, bool coherent, const Common& common);

  const Scene& scene() const { return plan_ ? plan_->model.scene : given_; }

  /// The plan's, but for what the user named.
  MadeTracer make_tracer(const std::string& tracer, std::optional<Precision> precision) const;

  /// Asks `rays`, directions of unit length, of exact arithmetic too; says what was found. Throws Error when the
  /// promise is broken, with a ray that shows it.
  Json verify(Tracer& tracer, const std::vector<Ray>& rays) const;

  /// A table of the choices, and what was replaced.
  std::string text() const;
  /// Null without a plan.
  Json json() const;

 private:
  PlanningOptions options_;
  const Common& common_;
  Scene given_;
  std::optional<Planned> plan_;
};

/// Keeps the measurements of this machine for later plans.
void measure_machine(const Common& common);

}  // namespace rayengine::cli
