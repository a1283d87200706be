#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>

#include "engine/load/atomic_file.h"
#include "examples/cli/cli.h"
#include "examples/cli/planning.h"

namespace rayengine::cli {
namespace {

struct Options {
  Common common;
  std::filesystem::path scene, json;
  std::optional<glm::ivec2> size;
  PlanningOptions planning{.tolerance = 0.5, .effort = {.prepare = true}};
  bool measure = false;
};

int run(const Options& o) {
  if (!o.json.empty()) check_output(o.json);
  const ThreadLimit limit(o.common.threads);
  if (o.measure) measure_machine(o.common);
  if (o.scene.empty()) return 0;
  Scene scene = load(o.scene, o.common).scene;
  if (o.size) scene.camera.size = *o.size;
  const Camera camera = scene.camera;
  const double rays = expected_rays(scene, 1);
  const PlannedScene planned(o.planning, std::move(scene), rays, true, o.common);
  std::cout << planned.text();
  Json json = planned.json();
  if (o.planning.verify > 0) {
    const MadeTracer made = planned.make_tracer("auto", {});
    json["verified"] = planned.verify(*made.tracer, random_camera_rays(camera, o.planning.verify));
  }
  if (!o.json.empty()) write_json(o.json, json);
  return 0;
}

/// Without a scene there is only the machine to look at.
void check(const Options& o) {
  if (o.scene.empty() && !o.measure) throw CLI::RequiredError("SCENE");
}

}  // namespace

void add_plan(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub = add_subcommand(
      app, "plan", "Say what a tolerance makes of a scene, and why",
      "  rayengine plan gears.nff --tolerance 0.5\n"
      "  rayengine plan frame.stl --tolerance 0.1 --size 1920x1080 --verify 100000\n"
      "  rayengine plan --measure\n\n"
      "Each choice with its predicted cost and error, and the alternative that it beat. The same tolerance given to\n"
      "render carries the plan out; trace takes one in units of the scene.",
      options->common);
  add_scene(sub, options->scene);
  add_planning(sub, options->planning);
  add_size(sub, options->size, "the scene's");
  sub->add_flag("--measure", options->measure,
                "First measure this machine (half a minute), and keep that for all plans");
  sub->add_option("--json", options->json, "The same as JSON")->type_name("FILE");
  sub->callback([options, &action] {
    check(*options);
    action = [options] { return run(*options); };
  });
}

}  // namespace rayengine::cli
