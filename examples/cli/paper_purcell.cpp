#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <map>

#include "engine/measure/purcell.h"
#include "engine/measure/ralovich_scenes.h"
#include "examples/cli/chart.h"
#include "examples/cli/paper.h"
#include "examples/cli/progress.h"
#include "examples/cli/report.h"

namespace rayengine::cli {
namespace {

/// Of one resolution, by state.
using ByResolution = std::map<unsigned, std::map<std::string, PurcellRow>>;
constexpr std::array states{"traverse", "intersect", "shade"};

ByResolution by_resolution(const PurcellFigures& figures) {
  ByResolution result;
  for (const PurcellRow& row : figures.rows) result[row.resolution][row.state] = row;
  return result;
}

glm::ivec2 size_of(const PaperOptions& o) { return o.size.value_or(PurcellOptions{}.size); }

PurcellFigures measure(const PaperOptions& o) {
  const auto scenes = load_scenes(o);
  Progress progress("paper purcell", !o.common.quiet());
  return purcell(scenes.empty() ? cornell_knot() : scenes[0].second,
                 {.gpu = o.common.gpu, .size = size_of(o), .progress = [&](double share) { progress.update(share); }});
}

std::string csv(const std::vector<PurcellRow>& rows) {
  std::string text = "resolution,state,passes,milliseconds\n";
  for (const PurcellRow& r : rows)
    text += fmt::format("{},{},{},{:.3f}\n", r.resolution, r.state, r.passes, r.milliseconds);
  return text;
}

std::string csv(const std::vector<PurcellPolicyRow>& rows) {
  std::string text = "policy,steps,passes,milliseconds\n";
  for (const PurcellPolicyRow& r : rows)
    text += fmt::format("\"{}\",{},{},{:.3f}\n", r.policy, r.steps, r.passes, r.milliseconds);
  return text;
}

/// Passes beside time, a bar for each resolution in which states are stacked.
std::string chart_commands(const ByResolution& rows) {
  std::string text = "$data << END\n";
  for (const auto& [resolution, row] : rows) {
    text += std::to_string(resolution);
    for (const char* state : states)
      text += fmt::format(" {} {:.3f}", row.at(state).passes, row.at(state).milliseconds);
    text += '\n';
  }
  text +=
      "END\nset style data histogram\nset style histogram rowstacked\nset style fill solid 0.8\nset boxwidth 0.7\n"
      "set yrange [0:*]\nset grid ytics\nset key top left\nset xtics scale 0\nset xlabel 'voxels along an axis'\n"
      "set multiplot layout 1,2\n";
  for (const auto& [column, label] : {std::pair{2, "passes a picture"}, std::pair{3, "milliseconds a picture"}})
    text += fmt::format(
        "set ylabel '{}'\nplot $data using {}:xtic(1) title 'traverse', '' using {} title 'intersect', '' using {} "
        "title 'shade'\n",
        label, column, column + 2, column + 4);
  return text + "unset multiplot\n";
}

std::string resolutions_table(const ByResolution& rows) {
  std::string text =
      "| voxels along an axis | passes | ms | traverse | intersect | shade |\n|---|---|---|---|---|---|\n";
  for (const auto& [resolution, row] : rows) {
    double passes = 0, milliseconds = 0;
    for (const char* state : states)
      passes += static_cast<double>(row.at(state).passes), milliseconds += row.at(state).milliseconds;
    text += fmt::format("| {} | {} | {:.0f} |", resolution, passes, milliseconds);
    for (const char* state : states)
      text += fmt::format(" {:.0f} % of passes, {:.0f} % of time |",
                          100 * static_cast<double>(row.at(state).passes) / passes,
                          100 * row.at(state).milliseconds / milliseconds);
    text += '\n';
  }
  return text;
}

std::string policies_table(const std::vector<PurcellPolicyRow>& rows) {
  std::string text = "| which kernel runs | voxels a pass | passes | ms |\n|---|---|---|---|\n";
  for (const PurcellPolicyRow& r : rows)
    text += fmt::format("| {} | {} | {} | {:.0f} |\n", r.policy, r.steps, r.passes, r.milliseconds);
  return text;
}

/// What the figures say of the paper's caution against switching too often, at its one voxel a pass.
std::string verdict(const PurcellFigures& figures) {
  const PurcellPolicyRow& by_turns = figures.policies.front();
  const PurcellPolicyRow& chosen = *std::ranges::min_element(
      figures.policies, {}, [](const PurcellPolicyRow& r) { return r.steps == 1 ? r.passes : ~std::size_t{0}; });
  std::string text = fmt::format(
      "The paper warns against switching kernels too often. At one voxel a pass, to choose by counts (\"{}\") takes {} "
      "passes where one kernel after the other takes {}, ",
      chosen.policy, chosen.passes, by_turns.passes);
  text += chosen.passes < by_turns.passes ? "which is the paper's trend" : "which is not the paper's trend";
  text += fmt::format("; in time it is {:.0f} ms against {:.0f}", chosen.milliseconds, by_turns.milliseconds);
  return text +
         (chosen.milliseconds < by_turns.milliseconds
              ? ", as the paper has it.\n"
              : ": here the trend is another, since the passes that count cost more than those that they spare.\n");
}

std::string page(const PurcellFigures& figures, const glm::ivec2& size, bool chart) {
  std::string text = fmt::format(
      "# The stream ray tracer's experiment\n\nPurcell, Buck, Mark, Hanrahan, \"Ray Tracing on Programmable Graphics "
      "Hardware\" (2002), on {}: a picture of {} x {} eye rays, each followed by one reflected ray where it meets a "
      "mirror, "
      "and by one to the light where it does not; the fastest of three{}.\n\n"
      "One voxel a traverse pass, as in the paper; the kernel runs that most rays wait for:\n\n",
      figures.device, size.x, size.y,
      figures.software ? ", in milliseconds of the processor, summed over its cores" : "");
  text += resolutions_table(by_resolution(figures));
  if (chart) text += "\n![Passes and time against the grid's resolution](purcell.svg)\n";
  text += fmt::format(
      "\nWays to choose the next kernel, at the resolution that `grid` takes ({} voxels along an axis):\n\n",
      figures.usual_resolution);
  return text + policies_table(figures.policies) + "\n" + verdict(figures);
}

}  // namespace

int run_purcell(const PaperOptions& o) {
  if (o.scenes.size() > 1) refuse("SCENE", "paper purcell measures one scene: name no more");
  prepare_folder(o, {"purcell.csv", "purcell-policies.csv", "purcell.md"});
  const PurcellFigures figures = measure(o);
  write_text(o.output / "purcell.csv", csv(figures.rows));
  write_text(o.output / "purcell-policies.csv", csv(figures.policies));
  const bool drawn = draw_chart(o.output / "purcell", chart_commands(by_resolution(figures)), "900,400");
  if (!drawn) note(o.common, "gnuplot is not installed: the chart is left out, its figures are in purcell.csv");
  const std::string text = page(figures, size_of(o), drawn);
  write_text(o.output / "purcell.md", text);
  std::cout << text;
  return 0;
}

}  // namespace rayengine::cli
