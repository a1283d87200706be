#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "examples/cli/chart_report.h"

namespace rayengine::cli {
namespace {

constexpr std::array colours{"#1b6ca8", "#c2571a", "#3d8b40", "#7a3e9d", "#a8324e", "#8a6d1f", "#2a8c8c", "#555555"};

/// A point's shape tells the precision.
int shape(Precision precision) {
  switch (precision) {
    case Precision::half: return 1;
    case Precision::fast: return 4;
    case Precision::robust: return 7;
    case Precision::certified: return 9;
  }
  return 7;
}

/// An error that a panel shows; what is smaller than the floor, 0 above all, is drawn there.
struct Panel {
  const char* title;
  double (*of)(const ChartRow&);
  double floor;
};
constexpr std::array panels{
    Panel{"median relative error of t", [](const ChartRow& r) { return r.errors.median_t_error; }, 1e-17},
    Panel{"worst relative error of t", [](const ChartRow& r) { return r.errors.max_t_error; }, 1e-17},
    Panel{"share of wrong decisions", [](const ChartRow& r) { return r.wrong_share(); }, 1e-6},
    Panel{"difference of the picture, RMSE", [](const ChartRow& r) { return r.rmse; }, 1e-9}};

std::vector<std::string> methods_of(const std::vector<ChartRow>& rows) {
  std::vector<std::string> names;
  for (const ChartRow& row : rows)
    if (row.level == 0 && std::ranges::find(names, row.method) == names.end()) names.push_back(row.method);
  return names;
}

template <class Wanted>
std::string data(const std::string& name, const std::vector<ChartRow>& rows, const Panel& panel, const Wanted& wanted) {
  std::string text = "$" + name + " << END\n";
  for (const ChartRow& row : rows)
    if (wanted(row))
      text += fmt::format("{} {} {} \"{}\"\n", row.mrays_per_s, std::max(panel.of(row), panel.floor),
                          shape(row.precision), row.level);
  return text + "END\n";
}

/// The best error at this speed or a higher one.
std::string front(std::vector<ChartRow> rows, const Panel& panel) {
  std::ranges::sort(rows, std::greater<>{}, &ChartRow::mrays_per_s);
  std::string text = "$front << END\n";
  double best = infinity;
  for (const ChartRow& row : rows) {
    const double error = std::max(panel.of(row), panel.floor);
    if (error >= best) continue;
    best = error;
    text += fmt::format("{} {}\n", row.mrays_per_s, error);
  }
  return text + "END\n";
}

std::string draw(const std::vector<ChartRow>& rows, const Panel& panel) {
  const std::vector<std::string> methods = methods_of(rows);
  std::string blocks = front(rows, panel), plots;
  for (std::size_t i = 0; i < methods.size(); ++i) {
    const std::string block = fmt::format("m{}", i);
    blocks += data(block, rows, panel, [&](const ChartRow& r) { return r.level == 0 && r.method == methods[i]; });
    plots += fmt::format(
        "${0} using 1:2:3 with points pt variable ps 1.2 lc rgb '{1}' notitle, NaN with points pt 5 lc "
        "rgb '{1}' title '{2}', ",
        block, colours[i % colours.size()], methods[i]);
  }
  for (const Precision precision : {Precision::fast, Precision::robust}) {
    const auto wanted = [=](const ChartRow& r) { return r.level > 0 && r.precision == precision; };
    if (std::ranges::none_of(rows, wanted)) continue;
    const std::string block = fmt::format("t{}", to_string(precision));
    blocks += data(block, rows, panel, wanted);
    plots += fmt::format(
        "${0} using 1:2:3 with linespoints pt variable ps 0.7 lc rgb '#999999' title 'triangles, {1}', ${0} using "
        "1:2:4 "
        "with labels offset 0.8,0.5 font ',9' textcolor rgb '#777777' notitle, ",
        block, to_string(precision));
  }
  plots += "$front using 1:2 with steps dashtype 2 lc rgb 'black' title 'Pareto front'";
  double top = panel.floor;
  for (const ChartRow& row : rows) top = std::max(top, panel.of(row));
  return fmt::format("{}set title '{}'\nset yrange [{}:{}]\nplot {}\n", blocks, panel.title, panel.floor / 3, 5 * top,
                     plots);
}

std::string title(const DistanceRow& row) {
  return row.precision ? fmt::format("{} {}", row.method, to_string(*row.precision)) : row.method;
}

std::string series(const std::vector<DistanceRow>& rows, double (*of)(const DistanceRow&), double floor) {
  std::vector<DistanceRow> firsts;  // of each method
  for (const DistanceRow& r : rows)
    if (std::ranges::find(firsts, title(r), title) == firsts.end()) firsts.push_back(r);
  std::string blocks, plots;
  for (std::size_t i = 0; i < firsts.size(); ++i) {
    blocks += fmt::format("$d{} << END\n", i);
    for (const DistanceRow& r : rows)
      if (title(r) == title(firsts[i])) blocks += fmt::format("{} {}\n", r.distance, std::max(of(r), floor));
    blocks += "END\n";
    plots += fmt::format("{}$d{} using 1:2 with linespoints pt {} ps 0.8 lc rgb '{}' title '{}'", i ? ", " : "", i,
                         firsts[i].precision ? shape(*firsts[i].precision) : 2, colours[i % colours.size()],
                         title(firsts[i]));
  }
  return blocks + fmt::format("set yrange [{}:*]\nplot {}\n", floor / 3, plots);
}

/// Where a form of the quadratic breaks down in a precision, by numerics alone.
struct Breakdown {
  double distance;
  const char* label;
};

std::string breakdown_lines() {
  const double single = 0x1p-24, twice = 0x1p-53;
  const Breakdown lines[]{{std::pow(single, -.5), "b^2 - ac, float"},
                          {1 / single, "shifted, float"},
                          {std::pow(twice, -.5), "b^2 - ac, double"}};
  std::string text;
  for (const Breakdown& line : lines)
    text += fmt::format(
        "set arrow from {0}, graph 0 to {0}, graph 1 nohead dashtype 3 lc rgb 'black'\nset label '{1}' at {0}, graph "
        "0.98 "
        "rotate by 90 right offset -0.8,0 font ',9'\n",
        line.distance, line.label);
  return text;
}

/// In the margin that all panels leave at the right.
std::string key_beside_at(double top) {
  return fmt::format("set key at screen 0.995,{} right top Left reverse samplen 2 font ',9'\n", top);
}

constexpr const char* axes = "set logscale xy\nset grid\nset format y '10^{%L}'\n";

}  // namespace

std::string chart_commands(const SceneChart& scene) {
  std::string text = std::string(axes) +
                     "set xlabel 'Mrays/s'\nset multiplot layout 2,2 margins 0.06,0.83,0.06,0.95 spacing 0.07,0.11\n";
  bool first = true;
  for (const Panel& panel : panels) {
    text += first ? key_beside_at(0.95) : "set key off\n";
    text += draw(scene.rows, panel);
    first = false;
  }
  return text + "unset multiplot\n";
}

std::string distance_commands(const std::vector<DistanceRow>& rows) {
  return std::string(axes) + "set xlabel 'distance / radius'\nset format x '10^{%L}'\n" + breakdown_lines() +
         "set multiplot layout 1,2 margins 0.06,0.81,0.12,0.92 spacing 0.06\n" + key_beside_at(0.92) +
         "set title 'share of wrong decisions'\n" +
         series(
             rows, [](const DistanceRow& r) { return r.wrong_share; }, 1e-5) +
         "set key off\nset title 'worst error of t, in radii'\n" +
         series(
             rows, [](const DistanceRow& r) { return r.max_t_error; }, 1e-16) +
         "unset multiplot\n";
}

}  // namespace rayengine::cli
