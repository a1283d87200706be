#include "engine/measure/compare.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <iostream>

#include "engine/batched.h"
#include "engine/load/atomic_file.h"
#include "engine/load/npy.h"
#include "engine/measure/rays.h"
#include "engine/tracers.h"
#include "examples/cli/cli.h"
#include "examples/cli/errors.h"
#include "examples/cli/progress.h"
#include "examples/cli/report.h"

namespace rayengine::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
  Common common;
  fs::path scene, rays, json, save;
  std::string tracers;
  std::optional<Precision> precision;
  std::optional<glm::ivec2> size;
};

struct Result {
  std::string tracer;
  Precision precision;
  Comparison comparison;
};

/// Which tracer the others are held against: `reference` when it is named, else the first.
std::size_t oracle_index(const std::vector<std::string>& names) {
  const auto at = std::ranges::find(names, "reference");
  return at == names.end() ? 0 : static_cast<std::size_t>(at - names.begin());
}

std::vector<std::string> names(const Options& o) {
  const std::vector<std::string> names = split(o.tracers);
  if (names.size() < 2) refuse("--tracers", "needs two names or more, as in embree,reference");
  for (const std::string& name : names) check_tracer("--tracers", name);
  return names;
}

std::vector<Ray> rays_for(const Options& o, Camera camera) {
  if (!o.rays.empty()) return read_rays(o.rays);
  camera.size = o.size.value_or(glm::ivec2(256));
  return primary_rays(camera);
}

std::string answer(const Hit& hit) {
  if (!hit.hit()) return hit.status & status_invalid ? "invalid" : "miss";
  return fmt::format("object {} primitive {} t {:.17g} error {:.3g}", hit.object, hit.primitive, hit.t, hit.error);
}

/// In full precision, so that it can be asked again.
void print_ray(const Ray& ray) {
  std::cout << fmt::format("  ray {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", ray.origin.x,
                           ray.origin.y, ray.origin.z, ray.tmin, ray.direction.x, ray.direction.y, ray.direction.z,
                           ray.tmax);
}

void print_first(Tracer& tracer, Tracer& oracle, std::span<const Ray> rays, const Comparison& comparison) {
  for (const std::size_t i : comparison.first) {
    Hit hit, exact;
    tracer.closest(rays.subspan(i, 1), {&hit, 1}, RayClass::primary);
    oracle.closest(rays.subspan(i, 1), {&exact, 1}, RayClass::primary);
    std::cout << fmt::format("beyond bounds: ray {}\n", i);
    print_ray(rays[i]);
    std::cout << fmt::format("  {}: {}\n  {}: {}\n", tracer.name(), answer(hit), oracle.name(), answer(exact));
  }
}

Json to_json(const Options& o, const std::string& oracle, const std::vector<Result>& results) {
  Json rows = Json::array();
  for (const Result& result : results) {
    Json row = {{"tracer", result.tracer}, {"precision", to_string(result.precision)}};
    row.update(errors_json(result.comparison));
    row.update(details_json(result.comparison));
    rows.push_back(row);
  }
  return {{"scene", o.scene.string()},
          {"oracle", oracle},
          {"device", device(thread_count(o.common.threads))},
          {"rows", rows}};
}

void print_table(const std::string& oracle, const std::vector<Result>& results) {
  std::cout << fmt::format("against {}:\n{:<12} {:<10} {}\n", oracle, "tracer", "precision", errors_header());
  for (const Result& result : results)
    std::cout << fmt::format("{:<12} {:<10} {}\n", result.tracer, to_string(result.precision),
                             errors_row(result.comparison));
  for (const Result& result : results)
    std::cout << fmt::format("{}: t differs by float ulps: {}\n", result.tracer, histogram(result.comparison.ulps));
}

void save_rays(const Options& o, std::span<const Ray> rays, const std::vector<Result>& results) {
  std::vector<std::size_t> indices;
  for (const Result& result : results)
    indices.insert(indices.end(), result.comparison.first.begin(), result.comparison.first.end());
  std::ranges::sort(indices);
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  std::vector<Ray> chosen;
  for (const std::size_t i : indices) chosen.push_back(rays[i]);
  write_rays(o.save, chosen);
}

/// Both answer every ray; the few that the oracle is asked about again are not foreseen.
Result compare_with_progress(const Options& o, Tracer& tracer, Tracer& oracle, const Geometry& geometry,
                             std::span<const Ray> rays) {
  Progress progress("compare", !o.common.quiet());
  std::atomic<std::size_t> done = 0;
  const RaysDone count = [&](std::size_t n) {
    progress.update(static_cast<double>(done += n) / (2 * static_cast<double>(rays.size())));
  };
  Batched asked(tracer, count), exact(oracle, count);
  return {std::string(tracer.name()), tracer.precision(), compare(asked, exact, geometry, rays, RayClass::primary)};
}

void require_bounds(const std::vector<Result>& results) {
  for (const Result& result : results)
    if (const std::uint64_t beyond = result.comparison.beyond_bounds)
      throw Error(fmt::format("{} of {} answers by '{}' are beyond the stated bounds: replay them with --save-rays",
                              beyond, result.comparison.rays, result.tracer));
}

void check(const Options& o) {
  if (!o.json.empty()) check_output(o.json);
  if (!o.save.empty()) check_output(o.save);
}

int run(const Options& o) {
  check(o);
  const std::vector<std::string> tracer_names = names(o);
  const ThreadLimit limit(o.common.threads);
  const LoadedScene loaded = load(o.scene, o.common);
  const std::vector<Ray> rays = rays_for(o, loaded.scene.camera);
  const TracerOptions options{o.precision.value_or(Precision::robust), o.common.threads, o.common.gpu};
  std::vector<std::unique_ptr<Tracer>> tracers;
  for (const std::string& name : tracer_names) tracers.push_back(make_tracer(name, loaded.scene.geometry, options));
  Tracer& oracle = *tracers[oracle_index(tracer_names)];

  std::vector<Result> results;
  for (const auto& tracer : tracers)
    if (tracer.get() != &oracle)
      results.push_back(compare_with_progress(o, *tracer, oracle, *loaded.scene.geometry, rays));
  if (!o.json.empty()) write_json(o.json, to_json(o, std::string(oracle.name()), results));
  if (!o.save.empty()) save_rays(o, rays, results);
  print_table(std::string(oracle.name()), results);
  std::size_t row = 0;
  for (const auto& tracer : tracers)
    if (tracer.get() != &oracle) print_first(*tracer, oracle, rays, results[row++].comparison);
  require_bounds(results);
  return 0;
}

}  // namespace

void add_compare(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub = add_subcommand(app, "compare", "Compare what tracers answer to the same rays",
                                 "  rayengine compare scenes/glass.json --tracers embree,reference\n"
                                 "  rayengine compare bunny.ply --tracers embree,reference --rays rays.npy --json "
                                 "bunny.json --save-rays worst.npy\n\n"
                                 "'reference' is taken as exact when it is named, else the first tracer is. A "
                                 "difference is ambiguous when the exact\n"
                                 "answer itself changes as the ray moves by the tracer's rounding, else it is beyond "
                                 "bounds, and the exit code is 1.",
                                 options->common);
  add_scene(sub, options->scene)->required();
  sub->add_option("--tracers", options->tracers, "Two tracers or more, with commas between")
      ->type_name("A,B,...")
      ->required();
  add_precision(sub, options->precision);
  CLI::Option* size = add_size(sub, options->size, "256x256");
  sub->add_option("--rays", options->rays, "Rays to compare on, instead of the camera's")
      ->type_name("RAYS.npy")
      ->excludes(size);
  sub->add_option("--json", options->json, "The same as JSON")->type_name("FILE");
  sub->add_option("--save-rays", options->save, "Where to write the first rays that are beyond bounds")
      ->type_name("FILE.npy");
  sub->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace rayengine::cli
