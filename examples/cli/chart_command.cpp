#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <set>

#include "engine/load/atomic_file.h"
#include "examples/cli/chart.h"
#include "examples/cli/chart_report.h"
#include "examples/cli/cli.h"
#include "examples/cli/progress.h"

namespace rayengine::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
  Common common;
  std::vector<fs::path> scenes;
  fs::path output;
};

void note_left_out(const Options& o, const std::vector<std::string>& left_out) {
  if (o.common.verbosity == Verbosity::verbose)
    for (const std::string& text : left_out) note(o.common, "left out: " + text);
}

/// The names of files and of what is shown.
std::string name_of(const fs::path& scene) { return scene.stem().string(); }

ChartOptions chart_options(const Options& o, Progress& progress) {
  return {o.common.threads, o.common.gpu, [&](double share) { progress.update(share); }};
}

SceneChart measure(const Options& o, const fs::path& file) {
  const LoadedScene loaded = load(file, o.common);
  Progress progress("chart " + name_of(file), !o.common.quiet());
  std::vector<std::string> left_out;
  SceneChart result{name_of(file), chart(loaded.scene, chart_options(o, progress), left_out)};
  note_left_out(o, left_out);
  return result;
}

std::vector<DistanceRow> measure_distances(const Options& o) {
  Progress progress("chart: distances", !o.common.quiet());
  std::vector<std::string> left_out;
  return distance_sweep(chart_options(o, progress), left_out);
}

void print(const SceneChart& scene) {
  std::cout << fmt::format("{}\n{:<14} {:<10} {:>9} {:>9} {:>10} {:>10} {:>10} {:>9} {:>9}\n", scene.name, "method",
                           "precision", "Mrays/s", "wrong", "median t", "worst t", "RMSE", "memory", "build");
  for (const ChartRow& r : scene.rows)
    std::cout << fmt::format("{:<14} {:<10} {:>9.3g} {:>9.2g} {:>10.1e} {:>10.1e} {:>10.1e} {:>9} {:>9}{}\n", r.method,
                             to_string(r.precision), r.mrays_per_s, r.wrong_share(), r.errors.median_t_error,
                             r.errors.max_t_error, r.rmse, bytes_text(static_cast<double>(r.bytes)),
                             seconds_text(r.build_seconds), r.fastest_so_accurate ? "  on the front" : "");
  if (const std::string text = verdict(scene.rows); !text.empty()) std::cout << text << '\n';
  std::cout << std::endl;
}

bool draw(const Options& o, const std::vector<SceneChart>& scenes, const std::vector<DistanceRow>& distances) {
  bool drawn = draw_chart(o.output / "distance", distance_commands(distances), "1200,520");
  for (const SceneChart& scene : scenes) drawn &= draw_chart(o.output / scene.name, chart_commands(scene), "1200,960");
  if (!drawn) note(o.common, "gnuplot is not installed: the charts are left out, their figures are in chart.csv");
  return drawn;
}

/// Two scenes of one name would be drawn over each other.
void check_names(const std::vector<fs::path>& scenes) {
  std::set<std::string> names{"distance", "chart"};
  for (const fs::path& scene : scenes)
    if (!names.insert(name_of(scene)).second)
      refuse("SCENE", "the name '" + name_of(scene) + "' is taken: rename the file");
}

int run(const Options& o) {
  check_names(o.scenes);
  fs::create_directories(o.output);
  for (const char* name : {"chart.csv", "distance.csv", "chart.json", "index.html"}) check_output(o.output / name);
  const ThreadLimit limit(o.common.threads);
  std::vector<SceneChart> scenes;
  for (const fs::path& file : o.scenes) {
    scenes.push_back(measure(o, file));
    print(scenes.back());
  }
  const std::vector<DistanceRow> distances = measure_distances(o);
  const Json machine = device(thread_count(o.common.threads));
  Json json = {{"device", machine}};
  json.update(chart_json(scenes, distances));
  write_text(o.output / "chart.csv", chart_csv(scenes));
  write_text(o.output / "distance.csv", distance_csv(distances));
  write_json(o.output / "chart.json", json);
  const bool drawn = draw(o, scenes, distances);
  write_text(o.output / "index.html", chart_page(scenes, machine, drawn));
  return 0;
}

}  // namespace

void add_chart(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub = add_subcommand(
      app, "chart", "Chart speed against accuracy, of every tracer and precision and of tessellations",
      "  rayengine chart scenes/gallery.json -o charts\n"
      "  rayengine chart balls.nff bunny.ply -o charts && xdg-open charts/index.html\n\n"
      "On the rays of each scene's camera, at most 256x256: rays a second, share of wrong decisions, median and worst\n"
      "error of t, difference of the picture, memory and build time; and how errors grow with distance. Writes\n"
      "index.html, which explains how to read it, with .svg and .png by gnuplot, .csv and .json.",
      options->common);
  sub->add_option("SCENE", options->scenes, "Scenes to chart")->type_name("")->required();
  sub->add_option("-o,--output", options->output, "Folder for what results")->type_name("DIR")->required();
  sub->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace rayengine::cli
