#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <iterator>
#include <map>

#include "engine/measure/ralovich.h"
#include "examples/cli/chart.h"
#include "examples/cli/paper.h"
#include "examples/cli/progress.h"
#include "examples/cli/report.h"

namespace rayengine::cli {
namespace {

struct Results {
  GpuInfo gpu;
  glm::ivec2 size, stages_size;
  std::vector<CastTime> casts;
  std::vector<StageShares> stages;

  /// Of a renderer in software the processor's time is the whole work, whatever else runs beside it.
  double milliseconds(const CastTime& c) const {
    return 1e3 * (gpu.software ? c.seconds.processor : c.seconds.elapsed);
  }
  const char* clock() const { return gpu.software ? "processor time, over all cores" : "elapsed time"; }

  const CastTime* find(std::string_view scene, CastMode mode, std::string_view method, int vertex_bytes) const {
    const auto found = std::ranges::find_if(casts, [&](const CastTime& c) {
      return c.scene == scene && c.mode == mode && c.method == method && c.vertex_bytes == vertex_bytes;
    });
    return found == casts.end() ? nullptr : &*found;
  }
};

/// What the paper measured, milliseconds at 512x512 on a GeForce 8600, by triangles: its table 3.
struct Published {
  std::array<double, 3> points, fragment;  ///< RC, SC, RT
};
const std::map<std::size_t, Published> published{{36, {{64.4, 213, 353}, {17.5, 48.5, 119}}},
                                                 {1024, {{104, 381, 664}, {26.8, 75.3, 222}}},
                                                 {69451, {{295, 419, 529}, {109, 182, 381}}}};

/// The scenes by whose sizes the paper's table 1 shares the stages' work.
constexpr std::size_t most_in_table_1 = 646;

std::string times_csv(const Results& r) {
  std::string text = "scene,triangles,mode,method,milliseconds\n";
  for (const CastTime& c : r.casts)
    if (c.vertex_bytes < 64)
      text += fmt::format("{},{},{},{},{:.3f}\n", c.scene, c.triangles, to_string(c.mode), c.method, r.milliseconds(c));
  return text;
}

std::string vertices_csv(const Results& r) {
  std::string text = "scene,triangles,mode,method,vertex_bytes,milliseconds,elapsed_milliseconds\n";
  for (const CastTime& c : r.casts)
    text += fmt::format("{},{},{},{},{},{:.3f},{:.3f}\n", c.scene, c.triangles, to_string(c.mode), c.method,
                        c.vertex_bytes, r.milliseconds(c), 1e3 * c.seconds.elapsed);
  return text;
}

std::string stages_csv(const Results& r) {
  std::string text = "scene,triangles,mode,vertex_percent,geometry_percent,fragment_percent\n";
  for (const StageShares& s : r.stages)
    text += fmt::format("{},{},{},{:.1f},{:.1f},{:.1f}\n", s.scene, s.triangles, to_string(s.mode), s.vertex,
                        s.geometry, s.fragment);
  return text;
}

/// Three bars for each scene and mode.
std::string times_chart(const Results& r) {
  std::string data = "$data << END\n";
  for (const CastTime& c : r.casts) {
    if (c.method != "fragment") continue;
    data += fmt::format("\"{}\\n{}\" {} {} {}\n", to_string(c.mode), c.mode == CastMode::SC ? c.scene : "",
                        r.milliseconds(*r.find(c.scene, c.mode, "points", 32)),
                        r.milliseconds(*r.find(c.scene, c.mode, "points_without_gs", 48)), r.milliseconds(c));
  }
  return data +
         "END\nset style data histogram\nset style fill solid 0.8\nset logscale y\nset ylabel 'milliseconds'\n"
         "set grid ytics\nset key outside top horizontal\nset xtics noenhanced\nset bmargin 4\n"
         "plot $data using 2:xtic(1) title 'points', '' using 3 title 'without geometry shader', "
         "'' using 4 title 'fragment'";
}

std::string stages_chart(const Results& r) {
  std::string data = "$data << END\n";
  for (const StageShares& s : r.stages)
    data += fmt::format("\"{}\\n{}\" {} {} {}\n", to_string(s.mode), s.mode == CastMode::SC ? s.scene : "", s.vertex,
                        s.geometry, s.fragment);
  return data +
         "END\nset style data histogram\nset style histogram rowstacked\nset style fill solid 0.8\nset boxwidth 0.8\n"
         "set yrange [0:100]\nset ylabel 'percent'\nset key outside top horizontal\nset xtics noenhanced\nset bmargin "
         "4\n"
         "plot $data using 2:xtic(1) title 'vertex', '' using 3 title 'geometry', '' using 4 title 'fragment'";
}

std::string stages_table(const Results& r) {
  std::string text = fmt::format(
      "\n## Time by stage, every ray against every triangle\n\n{}x{}; percent. Vertex: intersection. Geometry: "
      "emitting, "
      "and writing to the next pass. Fragment: rasterizing points, shading, blending.\n\n"
      "| scene | triangles | mode | vertex | geometry | fragment |\n|---|---|---|---|---|---|\n",
      r.stages_size.x, r.stages_size.y);
  for (const StageShares& s : r.stages)
    text += fmt::format("| {} | {} | {} | {:.0f} | {:.0f} | {:.0f} |\n", s.scene, s.triangles, to_string(s.mode),
                        s.vertex, s.geometry, s.fragment);
  text +=
      "\nThe paper's, on a GeForce GTX 260, vertex shader, RC / SC / RT: room 67 / 48 / 55, Cornell box 85 / 77 / "
      "73, knight in box 99 / 99 / -; geometry shader at most 5.\n";
  constexpr std::array<std::pair<std::size_t, double>, 3> theirs{{{12, 67}, {36, 85}, {646, 99}}};
  for (const auto& [triangles, vertex] : theirs)
    for (const StageShares& s : r.stages)
      if (s.triangles == triangles && s.mode == CastMode::RC)
        text += fmt::format("In RC intersections take {:.0f} % of the work in {}, {}, where they took {} %.\n",
                            s.vertex, s.scene, against(s.vertex, vertex), vertex);
  return text;
}

/// Of two ways to cast the knot, how many times as long the first takes.
double ratio(const Results& r, const char* method, int bytes, const char* other, int other_bytes) {
  const CastTime *a = r.find("cornell knot", CastMode::RC, method, bytes),
                 *b = r.find("cornell knot", CastMode::RC, other, other_bytes);
  return r.milliseconds(*a) / r.milliseconds(*b);
}

/// What the figures say of the geometry shader's price, and of the guess that it is the size of vertices.
std::string shooting_verdict(const Results& r) {
  constexpr double their_shader = 4.9 / 3.3, their_loss = 10.5 / 3.3;
  const double shader = ratio(r, "points", 64, "points_without_gs", 64), fat = ratio(r, "points", 64, "fragment", 0),
               small = ratio(r, "points", 32, "fragment", 0);
  return fmt::format(
             "\nWith a geometry shader rays take {:.2f} times as long as without, {} ({:.2f}). Beside a fragment "
             "shader "
             "they take {:.2f} times as long, {} ({:.2f}).",
             shader, against(shader, their_shader), their_shader, fat, against(fat, their_loss), their_loss) +
         fmt::format(
             " It guessed that vertices of 64 bytes are the reason: with 32, which are also shaded before they are "
             "drawn, it is {:.2f} times. {}\n",
             small,
             fat <= 1       ? "There is no loss to explain."
             : small <= 1.1 ? "The guess is right here."
             : small >= fat ? "The guess is wrong here."
                            : "Here that is a part of the reason, and not the whole.");
}

std::string shooting_table(const Results& r) {
  std::string text =
      "\n## Rays alone\n\nThe knot in the Cornell box, RC: every ray hits.\n\n"
      "| setup | bytes a ray | Mrays/s | the paper's |\n|---|---|---|---|\n";
  const double rays = static_cast<double>(r.size.x) * r.size.y;
  const auto row = [&](const char* setup, const char* method, int bytes, const char* paper) {
    if (const CastTime* c = r.find("cornell knot", CastMode::RC, method, bytes))
      text += fmt::format("| {} | {} | {:.2f} | {} |\n", setup, bytes ? std::to_string(bytes) : "-",
                          rays / r.milliseconds(*c) / 1e3, paper);
  };
  row("pass-through geometry shader", "points", 64, "3.3");
  row("the same, smaller vertices", "points", 32, "");
  row("no geometry shader", "points_without_gs", 64, "4.9");
  row("the same, smaller vertices", "points_without_gs", 48, "");
  row("fragment shader", "fragment", 0, "10.5");
  return text + shooting_verdict(r);
}

/// Where casting small vertices loses most.
std::string dearest_cast(const Results& r) {
  double most = 0;
  std::string where;
  for (const CastTime& c : r.casts) {
    if (c.mode != CastMode::RC || c.method != "fragment") continue;
    const double ratio = r.milliseconds(*r.find(c.scene, c.mode, "points", 32)) / r.milliseconds(c);
    if (ratio > most) most = ratio, where = c.scene;
  }
  return fmt::format("\nIn RC `points` takes at most {:.2f} times as long as `fragment`, in {}.\n", most, where);
}

std::string times_table(const Results& r) {
  std::string text = fmt::format(
      "\n## Ray casting, shadows, reflections\n\n{}x{}, milliseconds ({}); in brackets the paper's on a GeForce 8600, "
      "where "
      "the scene is of the same size.\n\n"
      "| scene | triangles | mode | points, 64 bytes | points, 32 bytes | without geometry shader | fragment | "
      "points / fragment |\n|---|---|---|---|---|---|---|---|\n",
      r.size.x, r.size.y, r.clock());
  for (const CastTime& c : r.casts) {
    if (c.method != "fragment") continue;
    const auto place = static_cast<std::size_t>(c.mode);
    const auto paper = published.find(c.triangles);
    const auto theirs = [&](auto member) {
      return paper == published.end() ? std::string() : fmt::format(" ({:.4g})", (paper->second.*member)[place]);
    };
    const double points = r.milliseconds(*r.find(c.scene, c.mode, "points", 32)), fragment = r.milliseconds(c);
    std::string ratio = fmt::format("{:.2f}", points / fragment);
    if (paper != published.end())
      ratio += fmt::format(" ({:.2f})", paper->second.points[place] / paper->second.fragment[place]);
    text += fmt::format("| {} | {} | {} | {:.1f}{} | {:.1f} | {:.1f} | {:.1f}{} | {} |\n", c.scene, c.triangles,
                        to_string(c.mode), r.milliseconds(*r.find(c.scene, c.mode, "points", 64)),
                        theirs(&Published::points), points,
                        r.milliseconds(*r.find(c.scene, c.mode, "points_without_gs", 48)), fragment,
                        theirs(&Published::fragment), ratio);
  }
  return text + dearest_cast(r);
}

std::string page(const Results& r, bool drawn) {
  std::string text = fmt::format(
      "# Rays in geometry shaders\n\nRalovich, Magdics, \"Recursive Ray Tracing in Geometry Shader\" (2010), on {}. "
      "Medians, "
      "{}. One light; RT adds one reflection, whose hits have shadows of their own (the paper's have none: a pass "
      "less).\n",
      r.gpu.renderer, r.clock());
  text += stages_table(r);
  if (drawn) text += "\n![Time by stage](ralovich-stages.svg)\n";
  text += shooting_table(r) + times_table(r);
  if (drawn) text += "\n![Time by method](ralovich.svg)\n";
  return text;
}

Results measure(const PaperOptions& o) {
  Results r;
  r.gpu = Context(o.common.gpu).info();
  r.size = o.size.value_or(glm::ivec2(512, 512));
  r.stages_size = glm::max(r.size / 2, 1);
  std::vector<NamedScene> scenes = ralovich_scenes();
  for (auto& [name, scene] : load_scenes(o)) scenes.push_back({name, lit_as_ralovich(std::move(scene))});
  for (const NamedScene& scene : scenes) {
    Progress progress("paper ralovich: " + scene.name, !o.common.quiet());
    const RalovichOptions options{
        .gpu = o.common.gpu, .size = r.size, .progress = [&](double share) { progress.update(share); }};
    std::ranges::move(time_casts(scene, options), std::back_inserter(r.casts));
  }
  for (const NamedScene& scene : scenes) {
    if (scene.scene.geometry->primitive_count > most_in_table_1) continue;
    std::ranges::move(share_of_stages(scene, {.gpu = o.common.gpu, .size = r.stages_size}),
                      std::back_inserter(r.stages));
  }
  return r;
}

}  // namespace

int run_ralovich(const PaperOptions& o) {
  prepare_folder(o, {"ralovich.csv", "ralovich-vertices.csv", "ralovich-stages.csv", "ralovich.md"});
  const ThreadLimit limit(o.common.threads);
  Results results = measure(o);
  write_text(o.output / "ralovich.csv", times_csv(results));
  write_text(o.output / "ralovich-vertices.csv", vertices_csv(results));
  write_text(o.output / "ralovich-stages.csv", stages_csv(results));
  const bool drawn = draw_chart(o.output / "ralovich", times_chart(results), "1100,480") &&
                     draw_chart(o.output / "ralovich-stages", stages_chart(results), "900,420");
  if (!drawn) note(o.common, "gnuplot is not installed: the charts are left out, their figures are in ralovich*.csv");
  write_text(o.output / "ralovich.md", page(results, drawn));
  for (const CastTime& c : results.casts)
    if (c.vertex_bytes < 64)
      std::cout << fmt::format("{:<16} {:>8} {} {:<18} {:>10.2f} ms\n", c.scene, c.triangles, to_string(c.mode),
                               c.method, results.milliseconds(c));
  return 0;
}

}  // namespace rayengine::cli
