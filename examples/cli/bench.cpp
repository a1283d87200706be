#include "engine/measure/bench.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>

#include "engine/load/atomic_file.h"
#include "engine/measure/contestant.h"
#include "engine/measure/plan_bench.h"
#include "examples/cli/cli.h"
#include "examples/cli/errors.h"
#include "examples/cli/planning.h"
#include "examples/cli/progress.h"
#include "examples/cli/report.h"
#include "examples/cli/simulate.h"

namespace rayengine::cli {
namespace {

struct Options {
  Common common;
  std::vector<std::filesystem::path> scenes;
  std::filesystem::path json, csv;
  bool simulate = false;
  std::string tracers = "embree,embree-bare,embree-sphere,embree-tess";
  std::string precisions = "fast,robust";
  std::optional<glm::ivec2> size;
  PlanningOptions planning;
};

BenchOptions to_bench(const Options& o) {
  BenchOptions bench;
  bench.tracers = split(o.tracers);
  for (const std::string& name : bench.tracers)
    if (std::ranges::find(yardsticks(), name) == yardsticks().end()) check_tracer("--tracers", name);
  for (const std::string& name : split(o.precisions)) bench.precisions.push_back(to_precision(name));
  bench.size = o.size.value_or(bench.size);
  bench.threads = o.common.threads;
  return bench;
}

std::vector<BenchRow> measure(const Options& o, const std::filesystem::path& file) {
  const LoadedScene loaded = load(file, o.common);
  Progress progress("bench " + file.filename().string(), !o.common.quiet());
  BenchOptions options = to_bench(o);
  options.progress = [&](double share) { progress.update(share); };
  std::vector<std::string> left_out;
  std::vector<BenchRow> rows = bench(loaded.scene, options, left_out);
  if (o.common.verbosity == Verbosity::verbose)
    for (const std::string& text : left_out) note(o.common, "left out: " + text);
  return rows;
}

Json to_json(const std::filesystem::path& scene, const BenchRow& row) {
  Json json = {{"scene", scene.string()},
               {"tracer", row.tracer},
               {"precision", to_string(row.precision)},
               {"class", row.ray_class},
               {"rays", row.rays},
               {"mrays_per_s", row.mrays_per_s},
               {"mrays_per_s_iqr", row.mrays_per_s_iqr},
               {"build_s", row.build_seconds},
               {"bytes", row.bytes}};
  json.update(errors_json(row.errors));
  return json;
}

void print(const std::filesystem::path& scene, const std::vector<BenchRow>& rows) {
  std::cout << fmt::format("{}\n{:<14} {:<10} {:<8} {:>9} {:>9} {:>7} {:>9} {:>9} {}\n", scene.string(), "tracer",
                           "precision", "class", "rays", "Mrays/s", "IQR", "build", "memory", errors_header());
  for (const BenchRow& row : rows)
    std::cout << fmt::format("{:<14} {:<10} {:<8} {:>9} {:>9.2f} {:>7.2f} {:>9} {:>9} {}\n", row.tracer,
                             to_string(row.precision), row.ray_class, row.rays, row.mrays_per_s, row.mrays_per_s_iqr,
                             seconds_text(row.build_seconds), bytes_text(static_cast<double>(row.bytes)),
                             errors_row(row.errors));
  std::cout << std::endl;
}

PlanBench measure_plan(const Options& o, const std::filesystem::path& file) {
  Scene scene = load(file, o.common).scene;
  if (o.size) scene.camera.size = *o.size;
  Progress progress("bench " + file.filename().string(), !o.common.quiet());
  const PlanSource source(o.planning, o.common);
  return bench_plan(scene, source.for_rays(expected_rays(scene, 1), true), o.common.threads,
                    [&](double share) { progress.update(share); });
}

Json to_json(const PictureCost& c) {
  return {{"planning_s", c.planning}, {"build_s", c.build}, {"render_s", c.render}, {"bytes", c.bytes}};
}

void print(const std::filesystem::path& scene, const PlanBench& bench) {
  const PictureCost &without = bench.without, &with = bench.with;
  std::cout << fmt::format("{:<28} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}  {:.3g} times as fast, {:.3g} of the memory\n",
                           scene.filename().string(), seconds_text(without.build), seconds_text(without.render),
                           seconds_text(with.planning), seconds_text(with.build), seconds_text(with.render),
                           bench.replaced, without.seconds() / with.seconds(),
                           static_cast<double>(with.bytes) / static_cast<double>(without.bytes));
}

/// Whole pictures, as they are rendered without a plan and with one.
Json bench_plans(const Options& o) {
  std::cout << fmt::format("{:<28} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "without a plan, and with one", "build",
                           "render", "planning", "build", "render", "replaced");
  Json rows = Json::array();
  for (const std::filesystem::path& scene : o.scenes) {
    const PlanBench measured = measure_plan(o, scene);
    print(scene, measured);
    rows.push_back({{"scene", scene.string()},
                    {"tolerance", *o.planning.tolerance},
                    {"without", to_json(measured.without)},
                    {"with", to_json(measured.with)},
                    {"objects_replaced", measured.replaced}});
  }
  return rows;
}

/// What cannot be asked for together.
void check(const Options& o) {
  if (o.simulate && !o.scenes.empty()) refuse("--simulate", "takes no scenes: its devices are made");
  if (!o.simulate && !o.csv.empty()) refuse("--csv", "is written by --simulate alone");
  if (!o.simulate && o.scenes.empty()) throw CLI::RequiredError("SCENE");
  for (const auto& file : {o.json, o.csv})
    if (!file.empty()) check_output(file);
}

int run(const Options& o) {
  check(o);
  if (o.simulate) return simulate(o.json, o.csv);
  if (o.planning.tolerance) {
    const ThreadLimit limit(o.common.threads);
    const Json rows = bench_plans(o);
    if (!o.json.empty()) write_json(o.json, {{"device", device(thread_count(o.common.threads))}, {"plans", rows}});
    return 0;
  }
  to_bench(o);  // wrong names are told before anything is loaded
  const ThreadLimit limit(o.common.threads);
  Json rows = Json::array();
  for (const std::filesystem::path& scene : o.scenes) {
    const std::vector<BenchRow> measured = measure(o, scene);
    for (const BenchRow& row : measured) rows.push_back(to_json(scene, row));
    print(scene, measured);
  }
  if (!o.json.empty()) write_json(o.json, {{"device", device(thread_count(o.common.threads))}, {"rows", rows}});
  return 0;
}

}  // namespace

void add_bench(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub = add_subcommand(
      app, "bench", "Measure rays per second, and check the answers that were timed",
      "  rayengine bench scenes/sphereflake.json\n"
      "  rayengine bench bunny.ply koala.obj --tracers embree,embree-bare --json bench.json\n"
      "  rayengine bench bunny.ply --tolerance 0.5\n"
      "  rayengine bench --simulate --csv scheduler.csv\n\n"
      "Tracers take turns; figures are medians and quartile ranges of 9 runs after a warm-up, and errors are those of\n"
      "the answers to 2,048 of the same rays against 'reference'. Rays are the camera's (primary), from what they hit "
      "to\n"
      "the lights (shadow) and anywhere (bounce), and random chords of the scene (random).\n"
      "Yardsticks, left out where they cannot hold a scene: embree-bare is plain Embree 3 called on triangles,\n"
      "embree-sphere Embree's own spheres, embree-tess quadrics as triangles, 512 a sphere.",
      options->common);
  sub->add_option("SCENE", options->scenes, "Scenes to measure")->type_name("");
  sub->add_option("--tracers", options->tracers, "Tracers and yardsticks, with commas between")->type_name("A,B,...");
  sub->add_option("--precisions", options->precisions, "Precisions to measure each at")->type_name("P,Q,...");
  add_size(sub, options->size, "1024x1024");
  add_tolerance(sub, options->planning);
  sub->add_option("--json", options->json, "The same as JSON")->type_name("FILE");
  sub->add_flag("--simulate", options->simulate,
                "Run the scheduler's policy, and others beside it, on made devices instead of scenes");
  sub->add_option("--csv", options->csv, "The table of --simulate as CSV")->type_name("FILE");
  sub->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace rayengine::cli
