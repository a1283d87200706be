#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>

#include "engine/load/atomic_file.h"
#include "engine/measure/carr.h"
#include "examples/cli/chart.h"
#include "examples/cli/cli.h"
#include "examples/cli/progress.h"
#include "examples/cli/report.h"

namespace rayengine::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
  Common common;
  std::string name;
  std::vector<fs::path> scenes;
  fs::path output;
};

void write(const fs::path& file, const std::string& text) {
  AtomicFile out(file);
  out.write(text);
  out.commit();
}

std::vector<std::pair<std::string, Scene>> scenes_of(const Options& o) {
  std::vector<std::pair<std::string, Scene>> scenes;
  for (const fs::path& file : o.scenes) scenes.emplace_back(file.stem().string(), load(file, o.common).scene);
  if (scenes.empty()) {
    scenes.emplace_back("balls", many_balls());
    scenes.emplace_back("mesh", large_mesh());
  }
  return scenes;
}

std::vector<CarrRow> measure(const Options& o) {
  std::vector<CarrRow> rows;
  for (const auto& [name, scene] : scenes_of(o)) {
    Progress progress("paper carr: " + name, !o.common.quiet());
    const auto measured = carr(
        scene, name,
        {.threads = o.common.threads, .gpu = o.common.gpu, .progress = [&](double share) { progress.update(share); }});
    rows.insert(rows.end(), measured.begin(), measured.end());
  }
  return rows;
}

std::string csv(const std::vector<CarrRow>& rows) {
  std::string text = "row,rays_per_s,scene\n";
  for (const CarrRow& r : rows) text += fmt::format("\"{}\",{:.0f},{}\n", r.row, r.rays_per_s, r.scene);
  return text;
}

/// A group of bars for each row, one bar for each scene.
std::string chart_commands(const std::vector<CarrRow>& rows) {
  std::vector<std::string> names, scenes;
  for (const CarrRow& r : rows) {
    if (std::ranges::find(names, r.row) == names.end()) names.push_back(r.row);
    if (std::ranges::find(scenes, r.scene) == scenes.end()) scenes.push_back(r.scene);
  }
  std::string data = "$data << END\n", labels;
  for (std::size_t n = 0; n < names.size(); ++n) {
    std::string label = names[n];
    for (std::size_t at; (at = label.find(' ')) != label.npos;) label.replace(at, 1, "\\n");
    labels += fmt::format("{}\"{}\" {}", n ? ", " : "", label, n);
    for (std::size_t s = 0; s < scenes.size(); ++s)
      data += fmt::format(" {}", rows[s * names.size() + n].rays_per_s / 1e6);
    data += '\n';
  }
  std::string plots;
  for (std::size_t s = 0; s < scenes.size(); ++s)
    plots += fmt::format("{}$data using {} title '{}'", s ? ", " : "", s + 1, scenes[s]);
  return data + "END\nset style data histogram\nset style fill solid 0.8\nset yrange [0:*]\nset ylabel 'Mrays/s'\n" +
         "set grid ytics\nset key top left\nset bmargin 4\nset xtics scale 0 (" + labels + ")\nplot " + plots;
}

std::string page(const std::vector<CarrRow>& rows, const std::string& device, bool chart) {
  std::string text = "# The Ray Engine's experiment\n\nCarr, Hall, Hart, \"The Ray Engine\" (2002): " + device +
                     "\n\n| scene | row | Mrays/s |\n|---|---|---|\n";
  for (const CarrRow& r : rows) text += fmt::format("| {} | {} | {:.3g} |\n", r.scene, r.row, r.rays_per_s / 1e6);
  if (chart) text += "\n![Rays a second](carr.svg)\n";
  return text;
}

int run_carr(const Options& o) {
  fs::create_directories(o.output);
  for (const char* name : {"carr.csv", "carr.md"}) check_output(o.output / name);
  const ThreadLimit limit(o.common.threads);
  const std::vector<CarrRow> rows = measure(o);
  write(o.output / "carr.csv", csv(rows));
  const bool drawn = draw_chart(o.output / "carr", chart_commands(rows), "800,480");
  if (!drawn) note(o.common, "gnuplot is not installed: the chart is left out, its figures are in carr.csv");
  const std::string device = rayengine::cli::device(thread_count(o.common.threads))["processor"].get<std::string>();
  write(o.output / "carr.md", page(rows, fmt::format("{}, {} threads", device, thread_count(o.common.threads)), drawn));
  for (const CarrRow& r : rows)
    std::cout << fmt::format("{:<10} {:<28} {:>8.3f} Mrays/s\n", r.scene, r.row, r.rays_per_s / 1e6);
  return 0;
}

}  // namespace

void add_paper(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub = add_subcommand(
      app, "paper", "Repeat a paper's experiment, as table, chart and page",
      "  rayengine paper carr -o carr\n"
      "  rayengine paper carr balls.nff dragon.ply -o carr\n\n"
      "carr: processor alone, with a GPU read back synchronously and asynchronously, and with an infinitely fast one;\n"
      "  on 8,000 made balls and a made mesh of 200,000 triangles unless scenes are named.",
      options->common);
  sub->add_option("PAPER", options->name, "Which: carr")->type_name("")->required()->check(CLI::IsMember({"carr"}));
  sub->add_option("SCENE", options->scenes, "Scenes to use instead")->type_name("");
  sub->add_option("-o,--output", options->output, "Folder for what results")->type_name("DIR")->required();
  sub->callback([options, &action] { action = [options] { return run_carr(*options); }; });
}

}  // namespace rayengine::cli
