#include <fmt/format.h>

#include <iostream>

#include "engine/measure/carr.h"
#include "examples/cli/chart.h"
#include "examples/cli/paper.h"
#include "examples/cli/progress.h"
#include "examples/cli/report.h"

namespace rayengine::cli {
namespace {

std::vector<std::pair<std::string, Scene>> scenes_of(const PaperOptions& o) {
  auto scenes = load_scenes(o);
  if (scenes.empty()) {
    scenes.emplace_back("balls", many_balls());
    scenes.emplace_back("mesh", large_mesh());
  }
  return scenes;
}

std::vector<CarrRow> measure(const PaperOptions& o) {
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

}  // namespace

int run_carr(const PaperOptions& o) {
  prepare_folder(o, {"carr.csv", "carr.md"});
  const ThreadLimit limit(o.common.threads);
  const std::vector<CarrRow> rows = measure(o);
  write_text(o.output / "carr.csv", csv(rows));
  const bool drawn = draw_chart(o.output / "carr", chart_commands(rows), "800,480");
  if (!drawn) note(o.common, "gnuplot is not installed: the chart is left out, its figures are in carr.csv");
  const std::string device = rayengine::cli::device(thread_count(o.common.threads))["processor"].get<std::string>();
  write_text(o.output / "carr.md",
             page(rows, fmt::format("{}, {} threads", device, thread_count(o.common.threads)), drawn));
  for (const CarrRow& r : rows)
    std::cout << fmt::format("{:<10} {:<28} {:>8.3f} Mrays/s\n", r.scene, r.row, r.rays_per_s / 1e6);
  return 0;
}

}  // namespace rayengine::cli
