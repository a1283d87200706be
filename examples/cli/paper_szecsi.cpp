#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <numbers>

#include "engine/load/image_io.h"
#include "engine/measure/szecsi.h"
#include "examples/cli/chart.h"
#include "examples/cli/paper.h"
#include "examples/cli/progress.h"
#include "examples/cli/report.h"

namespace rayengine::cli {
namespace {

using Method = GlassOptions::Method;

std::string_view name_of(Method method) { return method == Method::ray_engine ? "ray_engine" : "hierarchical"; }

std::string csv(const std::vector<SzecsiRow>& rows) {
  std::string text = "triangles,size,method,frames_per_s\n";
  for (const SzecsiRow& r : rows)
    text += fmt::format("{},{},{},{:.4g}\n", r.triangles, r.size, name_of(r.method), r.frames_per_s);
  return text;
}

std::vector<int> sizes_of(const std::vector<SzecsiRow>& rows) {
  std::vector<int> sizes;
  for (const SzecsiRow& r : rows)
    if (std::ranges::find(sizes, r.size) == sizes.end()) sizes.push_back(r.size);
  return sizes;
}

/// Both axes logarithmic, as in the paper's figure 7: a line for each method and size.
std::string chart_commands(const std::vector<SzecsiRow>& rows) {
  std::string data, plots;
  for (const int size : sizes_of(rows))
    for (const Method method : {Method::ray_engine, Method::hierarchical}) {
      const std::string block = fmt::format("$d{}{}", size, static_cast<int>(method));
      data += block + " << END\n";
      for (const SzecsiRow& r : rows)
        if (r.size == size && r.method == method) data += fmt::format("{} {}\n", r.triangles, r.frames_per_s);
      data += "END\n";
      plots += fmt::format("{}{} with linespoints lw 2 title '{}, {}x{}'", plots.empty() ? "" : ", ", block,
                           method == Method::ray_engine ? "ray engine" : "hierarchical", size, size);
    }
  return data + "set logscale xy\nset xlabel 'triangles'\nset ylabel 'frames/s'\nset grid\nset key top right\nplot " +
         plots;
}

/// A panel for each generation, side by side, brighter where the cone is narrower; black where no path is left.
Image cones_image(const std::vector<SzecsiCones>& all) {
  constexpr int scale = 8, margin = 8;
  const glm::ivec2 panel = scale * all.front().tiles;
  const int step = panel.x + margin;
  Image image(static_cast<int>(all.size()) * step - margin, panel.y, {"R", "G", "B"});
  for (std::size_t i = 0; i < image.pixels.size(); i += 3) image.pixels[i + 2] = 0.2f;
  for (std::size_t p = 0; p < all.size(); ++p)
    for (int y = 0; y < panel.y; ++y)
      for (int x = 0; x < panel.x; ++x) {
        const float angle = all[p].angles[static_cast<std::size_t>(y / scale * all[p].tiles.x + x / scale)];
        std::fill_n(image.pixel(static_cast<int>(p) * step + x, y), 3, angle < 0 ? 0 : 1 / (1 + 16 * angle));
      }
  return image;
}

/// The hierarchical method's frames a second over the ray engine's.
double ratio(const std::vector<SzecsiRow>& rows, std::size_t triangles, int size) {
  double plain = 0, cones = 0;
  for (const SzecsiRow& r : rows)
    if (r.triangles == triangles && r.size == size) (r.method == Method::ray_engine ? plain : cones) = r.frames_per_s;
  return cones / plain;
}

std::string table(const std::vector<SzecsiRow>& rows) {
  std::string text =
      "| triangles | size | ray engine, frames/s | hierarchical, frames/s | ratio | passes timed "
      "|\n|---|---|---|---|---|---|\n";
  for (std::size_t i = 0; i + 1 < rows.size(); i += 2)
    text +=
        fmt::format("| {} | {}x{} | {:.3g} | {:.3g} | {:.3g} | {} |\n", rows[i].triangles, rows[i].size, rows[i].size,
                    rows[i].frames_per_s, rows[i + 1].frames_per_s, ratio(rows, rows[i].triangles, rows[i].size),
                    rows[i].stride == 1 ? "all" : fmt::format("one in {}", rows[i].stride));
  return text;
}

std::string page(const SzecsiResult& result, const std::string& processor, bool chart) {
  constexpr double paper_100 = 2, paper_5000 = 3 / 0.23;
  const double gain_10 = ratio(result.rows, 10, 256), gain_100 = ratio(result.rows, 100, 256),
               gain_5000 = ratio(result.rows, 5000, 256);
  std::string text = fmt::format(
      "# The Hierarchical Ray Engine's experiment\n\n"
      "Szécsi, \"The Hierarchical Ray Engine\" (WSCG 2006), section 7, on {} ({}): glass bodies that fill "
      "the view, paths of five rays, then an environment.\n",
      result.device, processor);
  if (result.software)
    text += "The device is a renderer in software: a second is one of the processor's time, summed over its cores.\n";
  text += "Where only some of the ray engine's passes were timed, they count for the others.\n\n" + table(result.rows);
  text += fmt::format(
      "\n| hierarchical over ray engine, 256x256 | the paper, GeForce 6800 GT | here |\n|---|---|---|\n"
      "| 10 triangles | does not pay off | {:.2g} |\n| 100 triangles | {} | {:.2g} |\n| 5,000 triangles | 3 / 0.23 = "
      "{:.0f} | "
      "{:.2g} |\n",
      gain_10, paper_100, gain_100, paper_5000, gain_5000);
  text += fmt::format(
      "\nThe hierarchy gains {} at 100 triangles, and {} at 5,000. The scenes are ours: one body below 100 triangles, "
      "two below 1,000, then five, so that frames a second do not fall evenly where bodies are added. The paper works "
      "out "
      "the refracted ray in every test, here it is done once a generation.\n",
      against(gain_100, paper_100), against(gain_5000, paper_5000));
  if (chart) text += "\n![Frames a second against triangles](szecsi.svg)\n";
  return text +
         "\n![Openings of cones](szecsi-cones.png)\n\nHalf opening angles a of the cones around the rays of "
         "generations 1, 2, 4 "
         "and 8, a square for each tile of 16x16 rays,\n512x512, 5,000 triangles: brightness 1 / (1 + 16 a), black "
         "where all paths "
         "have ended.\n";
}

}  // namespace

int run_szecsi(const PaperOptions& o) {
  if (!o.scenes.empty()) refuse("SCENE", "paper szecsi makes its own scenes: name none");
  if (o.size) refuse("--size", "paper szecsi has its own sizes, 256x256 and 512x512: give none");
  prepare_folder(o, {"szecsi.csv", "szecsi.md", "szecsi-cones.png"});
  const ThreadLimit limit(o.common.threads);
  Progress progress("paper szecsi", !o.common.quiet());
  const SzecsiResult result = szecsi({.gpu = o.common.gpu, .progress = [&](double share) { progress.update(share); }});
  write_text(o.output / "szecsi.csv", csv(result.rows));
  write_image(o.output / "szecsi-cones.png", cones_image(szecsi_cones(o.common.gpu)));
  const bool drawn = draw_chart(o.output / "szecsi", chart_commands(result.rows), "800,520");
  if (!drawn) note(o.common, "gnuplot is not installed: the chart is left out, its figures are in szecsi.csv");
  const std::string processor = device(thread_count(o.common.threads))["processor"].get<std::string>();
  write_text(o.output / "szecsi.md", page(result, processor, drawn));
  for (const SzecsiRow& r : result.rows)
    std::cout << fmt::format("{:>6} triangles {:>4}x{:<4} {:<13} {:>9.4g} frames/s\n", r.triangles, r.size, r.size,
                             name_of(r.method), r.frames_per_s);
  return 0;
}

}  // namespace rayengine::cli
