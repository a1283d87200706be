#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iostream>

#include "engine/load/image_io.h"
#include "engine/measure/wood.h"
#include "examples/cli/chart.h"
#include "examples/cli/paper.h"
#include "examples/cli/progress.h"

namespace rayengine::cli {
namespace {

constexpr double paper_gpu = 1.11, paper_software = 0.53;

const WoodRow& row(const WoodFigures& figures, std::string_view method) {
  return *std::ranges::find(figures.rows, method, &WoodRow::method);
}

std::string csv(const WoodFigures& figures) {
  std::string text = "method,frames_per_s\n";
  for (const char* method : {"gpu", "software"})
    text += fmt::format("{},{:.4g}\n", method, row(figures, method).frames_per_s);
  return text;
}

std::string chart_commands(const WoodFigures& figures) {
  std::string text = "$data << END\n";
  for (const WoodRow& r : figures.rows) text += fmt::format("{} {}\n", r.method, r.frames_per_s);
  return text +
         "END\nset style data histogram\nset style fill solid 0.8\nset logscale y\nset ylabel 'frames/s'\nset grid "
         "ytics\n"
         "unset key\nplot $data using 2:xtic(1)";
}

std::string quadrics_table(const WoodFigures& figures) {
  std::string text = "| quadric | | A B C D E F G H I J |\n|---|---|---|\n";
  for (const WoodQuadric& q : figures.quadrics)
    text +=
        fmt::format("| {0} | ![{0}](wood-{0}.png) | {1} |\n", to_string(q.type), fmt::join(unit_matrix(q.type), " "));
  return text;
}

std::string verdict(double ratio) {
  if (ratio <= 1) return "The GPU does not gain: here the trend is another than in the paper.";
  return fmt::format("The GPU gains {}.", against(ratio, paper_gpu / paper_software));
}

std::string page(const WoodFigures& figures, const glm::ivec2& size, bool chart) {
  const double gpu = row(figures, "gpu").frames_per_s, software = row(figures, "software").frames_per_s,
               embree = row(figures, "embree").frames_per_s;
  std::string text = fmt::format(
      "# The ray caster's experiment\n\n"
      "Wood, McCane, King, \"Ray Tracing Arbitrary Objects on the GPU\" (2004), on {}: a sphereflake of {} spheres, "
      "{}x{},\nall that a method keeps of the scene made anew for every picture.{}\n\n",
      figures.device, figures.primitives, size.x, size.y,
      figures.software ? "\nThe device is a renderer in software: a second is one of the processor's time, summed over "
                         "its cores."
                       : "");
  text += fmt::format(
      "| method | the paper, frames/s | here, frames/s |\n|---|---|---|\n"
      "| GPU: a pass an object, rays and hits in 16-bit halves | {} | {:.3g} |\n"
      "| software: the same loop on the processor, in double | {} | {:.3g} |\n"
      "| ratio | {:.1f} | {:.2g} |\n"
      "| `embree`: a BVH, built for every picture | | {:.3g} |\n",
      paper_gpu, gpu, paper_software, software, paper_gpu / paper_software, gpu / software, embree);
  text += fmt::format("\n{} {:.2g} % of the GPU's pixels are off software's by more than 0.02.\n",
                      verdict(gpu / software), 100 * row(figures, "gpu").differing);
  if (chart) text += "\n![Frames a second](wood.svg)\n";
  return text + "\n![sphereflake](wood-gpu.png) ![by software](wood-software.png)\n\n" + quadrics_table(figures) +
         "\nThe surface is where x^T Q x = 0, with Q = [[A,B,C,D],[B,E,F,G],[C,F,H,I],[D,G,I,J]]; z is clipped.\n";
}

void write_pictures(const std::filesystem::path& folder, const WoodFigures& figures) {
  for (const WoodQuadric& q : figures.quadrics)
    write_image(folder / fmt::format("wood-{}.png", to_string(q.type)), q.picture);
  for (const char* method : {"gpu", "software"})
    write_image(folder / fmt::format("wood-{}.png", method), row(figures, method).picture);
}

}  // namespace

int run_wood(const PaperOptions& o) {
  if (!o.scenes.empty()) refuse("SCENE", "paper wood makes its own scenes: name none");
  const glm::ivec2 size = o.size.value_or(WoodOptions{}.size);
  check_size(size, 4);
  prepare_folder(o, {"wood.csv", "wood.md", "wood-gpu.png"});
  const ThreadLimit limit(o.common.threads);
  Progress progress("paper wood", !o.common.quiet());
  const WoodFigures figures =
      wood({.gpu = o.common.gpu, .size = size, .progress = [&](double share) { progress.update(share); }});
  write_text(o.output / "wood.csv", csv(figures));
  write_pictures(o.output, figures);
  const bool drawn = draw_chart(o.output / "wood", chart_commands(figures), "600,400");
  if (!drawn) note(o.common, "gnuplot is not installed: the chart is left out, its figures are in wood.csv");
  write_text(o.output / "wood.md", page(figures, size, drawn));
  for (const WoodRow& r : figures.rows) std::cout << fmt::format("{:<9} {:>9.4g} frames/s\n", r.method, r.frames_per_s);
  return 0;
}

}  // namespace rayengine::cli
