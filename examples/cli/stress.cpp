#include "engine/measure/stress/stress.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>

#include "engine/load/atomic_file.h"
#include "engine/tracers.h"
#include "examples/cli/canary.h"
#include "examples/cli/cli.h"
#include "examples/cli/progress.h"
#include "examples/cli/stress_report.h"

namespace rayengine::cli {
namespace {

struct Options {
  Common common;
  std::filesystem::path json, html;
  std::string tracers = all_tracers();
  std::string precisions = "half,fast,robust,certified";
  std::uint64_t rays = 200'000;

  /// All but the oracle, which is what the others are held against.
  static std::string all_tracers() {
    std::string names;
    for (const TracerInfo& info : tracer_list())
      if (info.name != "reference") names += (names.empty() ? "" : ",") + std::string(info.name);
    return names;
  }
};

StressOptions to_stress(const Options& o) {
  StressOptions stress{.rays = o.rays, .threads = o.common.threads, .gpu = o.common.gpu};
  stress.tracers = split(o.tracers);
  for (const std::string& name : stress.tracers) check_tracer("--tracers", name);
  for (const std::string& name : split(o.precisions)) stress.precisions.push_back(to_precision(name));
  return stress;
}

/// Whether bad input ends the process, found out in another one.
bool aborts(StressOptions options, const std::string& tracer, Precision precision) {
  options.tracers = {tracer}, options.precisions = {precision};
  options.families = {"bad input", "degenerate form"};
  options.rays = 1000;
  options.aborts = nullptr, options.progress = nullptr;
  return !survives([&] { stress(options); }, std::chrono::seconds(120));
}

/// Before any thread is started.
void try_bad_input(StressOptions& options) {
  std::vector<std::pair<std::string, Precision>> aborting;
  for (const std::string& tracer : options.tracers)
    for (const Precision precision : options.precisions)
      if (aborts(options, tracer, precision)) aborting.emplace_back(tracer, precision);
  options.aborts = [aborting](const std::string& tracer, Precision precision) {
    return std::ranges::count(aborting, std::pair(tracer, precision)) > 0;
  };
}

StressReport measure(const Options& o) {
  StressOptions options = to_stress(o);
  try_bad_input(options);
  const ThreadLimit limit(o.common.threads);
  Progress progress("stress", !o.common.quiet());
  options.progress = [&](double share) { progress.update(share); };
  return stress(options);
}

void print(const Options& o, const StressReport& report) {
  std::cout << stress_table(by_family(report.rows));
  for (const StressRow& row : report.rows)
    if (!row.broken.empty())
      std::cout << fmt::format("limit broken: {} {} on {}, {}: {}\n", row.tracer, to_string(row.precision), row.family,
                               row.variant, row.broken);
  for (const std::string& error : report.oracle_errors) std::cout << "the oracle is wrong: " << error << '\n';
  for (const std::string& text : report.left_out) note(o.common, "left out: " + text);
  if (!report.refused.empty() && o.common.verbosity != Verbosity::verbose)
    note(o.common, fmt::format("{} cases were refused by a tracer, and say so with --verbose", report.refused.size()));
  if (o.common.verbosity == Verbosity::verbose)
    for (const std::string& text : report.refused) note(o.common, "refused: " + text);
}

int run(const Options& o) {
  for (const auto& file : {o.json, o.html})
    if (!file.empty()) check_output(file);
  const StressReport report = measure(o);
  const Json machine = device(thread_count(o.common.threads));
  print(o, report);
  if (!o.json.empty()) {
    Json json = {{"device", machine}};
    json.update(stress_json(report));
    write_json(o.json, json);
  }
  if (!o.html.empty()) write_text(o.html, stress_page(report, machine));
  if (!report.good()) throw Error("limits are broken: the lines 'limit broken' above say which");
  return 0;
}

}  // namespace

void add_stress(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub = add_subcommand(
      app, "stress", "Run the stability suite: rays that are known to break ray tracers, against exact arithmetic",
      "  rayengine stress\n"
      "  rayengine stress --tracers bvh,embree --precisions robust --html stress.html\n"
      "  rayengine stress --rays 10000000 --json stress.json\n\n"
      "Counts false hits (hits+), false misses (misses+), wrong ids, those of them that the tracer's rounding "
      "explains\n"
      "(ambig.; at robust), what is left (beyond), stated bounds that are broken, and NaN; errors of t are relative, "
      "of\n"
      "points in sizes of what is hit, of normals in radians. Methods that fail are shown failing; 'robust' and\n"
      "'certified' have limits, and the exit code is 1 when one is broken. RAYENGINE_ISA=sse2|avx2|avx512 chooses the\n"
      "processor's instructions.",
      options->common);
  sub->add_option("--tracers", options->tracers, "Tracers, with commas between")->type_name("A,B,...");
  sub->add_option("--precisions", options->precisions, "Precisions of each, where it holds them")->type_name("P,Q,...");
  sub->add_option("--rays", options->rays, "Rays for each tracer and precision, over all cases")
      ->type_name("N")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000'000}).description(""));
  sub->add_option("--json", options->json, "All figures as JSON")->type_name("FILE");
  sub->add_option("--html", options->html, "A page with heat maps")->type_name("FILE");
  sub->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace rayengine::cli
