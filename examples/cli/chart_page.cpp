#include <fmt/format.h>

#include "examples/cli/chart_report.h"

namespace rayengine::cli {
namespace {

constexpr const char* head = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>RayEngine: speed against accuracy</title>
<style>
body { font: 14px/1.5 sans-serif; margin: 2em auto; max-width: 75em; padding: 0 1em; color: #222; background: #fff }
table { border-collapse: collapse; font-size: 12px }
th, td { padding: .15em .7em; text-align: right; border-bottom: 1px solid #ddd }
th:first-child, td:first-child { text-align: left }
tr.front { font-weight: bold }
img { max-width: 100% }
</style></head><body>
<h1>Speed against accuracy</h1>
)";

constexpr const char* how_to_read =
    R"(<p>Every point is one method on the same rays, those of the scene's camera, one to a pixel. Right is
faster and down is more exact, so the lower right corner is where to be. Colours are tracers; shapes are precisions: cross
<i>half</i>, open square <i>fast</i>, dot <i>robust</i>, triangle <i>certified</i>. Grey lines are the quadrics as triangles, traced by plain
Embree, from coarse (1) to fine (5); each level has four times the triangles of the one before. The dashed steps are the Pareto front: nothing is both faster and more
exact than what lies on it.</p>
<ul>
<li>Errors are against 128-bit arithmetic decided exactly. A wrong decision is a hit that is none, a miss that is none, or
another object or part of it. Errors of t are relative, where ids are right; an error of 0 is drawn on the lowest line.</li>
<li>The picture is what a light in the eye shows, |normal &middot; direction| from 0 to 1; its difference is the root of the mean
square over all pixels.</li>
<li>Rates are medians of seven runs in turns. Bold rows are on the front of the first panel.</li>
</ul>
)";

constexpr const char* about_distance =
    R"(<p>A unit sphere, rays at random from farther and farther away. Vertical lines are where theory has each
form of the quadratic break down: the textbook's b&sup2; - ac when distance / radius is near u<sup>-1/2</sup>, the form that is shifted
to the point closest to the centre near u<sup>-1</sup>, with u = 2<sup>-24</sup> for float and 2<sup>-53</sup> for double (whose shifted form breaks at
9e15, beyond this chart). A tracer in float that moves its rays' origins near in double first breaks down later than either.</p>
)";

std::string row_text(const ChartRow& r) {
  return fmt::format(
      "<tr{}><td>{} "
      "{}</td><td>{:.3g}</td><td>{:.2g}</td><td>{:.1e}</td><td>{:.1e}</td><td>{:.1e}</td><td>{}</td><td>{}</td>"
      "</tr>\n",
      r.fastest_so_accurate ? " class=\"front\"" : "", r.method, to_string(r.precision), r.mrays_per_s, r.wrong_share(),
      r.errors.median_t_error, r.errors.max_t_error, r.rmse, bytes_text(static_cast<double>(r.bytes)),
      seconds_text(r.build_seconds));
}

std::string table(const std::vector<ChartRow>& rows) {
  std::string text =
      "<table><tr><th>method</th><th>Mrays/s</th><th>wrong</th><th>median t error</th><th>worst</th><th>RMSE</th>"
      "<th>memory</th><th>build</th></tr>\n";
  for (const ChartRow& row : rows) text += row_text(row);
  return text + "</table>\n";
}

std::string image(const std::string& name, bool drawn) {
  return drawn ? fmt::format("<p><img src=\"{0}.svg\" alt=\"{0}\"></p>\n", name) : "";
}

}  // namespace

std::string chart_page(const std::vector<SceneChart>& scenes, const Json& device, bool drawn) {
  std::string text = head;
  text += fmt::format(
      "<p>{}, {} threads, {}. The figures: <a href=\"chart.csv\">chart.csv</a>, "
      "<a href=\"distance.csv\">distance.csv</a>, <a href=\"chart.json\">chart.json</a>.</p>\n",
      device["processor"].get<std::string>(), device["threads"].get<int>(), device["isa"].get<std::string>());
  text += how_to_read;
  for (const SceneChart& scene : scenes)
    text += fmt::format("<h2>{}</h2>\n<p>{} rays. {}</p>\n", scene.name,
                        scene.rows.empty() ? 0 : scene.rows.front().rays, verdict(scene.rows)) +
            image(scene.name, drawn) + table(scene.rows);
  text += "<h2>Distance</h2>\n" + std::string(about_distance) + image("distance", drawn);
  return text + "</body></html>\n";
}

}  // namespace rayengine::cli
