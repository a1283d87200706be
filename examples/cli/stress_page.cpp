#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "examples/cli/stress_report.h"

namespace rayengine::cli {
namespace {

constexpr const char* head = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>RayEngine: stability suite</title>
<style>
body { font: 14px/1.45 sans-serif; margin: 2em auto; max-width: 75em; padding: 0 1em; color: #222; background: #fff }
table { border-collapse: collapse; margin: .5em 0 1.5em; font-size: 12px }
th, td { padding: .2em .55em; text-align: right; border: 1px solid #fff; white-space: nowrap }
th { font-weight: normal; text-align: left; background: #eee }
td.broken { outline: 3px solid #000; outline-offset: -3px; font-weight: bold }
td.none { background: #f6f6f6; color: #999 }
details table { margin-left: 1.5em }
</style></head><body>
<h1>Stability suite</h1>
)";

constexpr const char* how_to_read =
    R"(<p>Each cell is one tracer at one precision on rays that are known to break ray tracers, held
against exact arithmetic. In the first map a cell says which share of the decisions was wrong: hits that are none, misses
that are none, another object or primitive. At <i>robust</i> those are left out that rounding of the size which the tracer
states explains: there a ray passes so close to an edge or outline that its own coordinates would have to be known better. A black frame
marks a limit that is broken. Only <i>robust</i> and <i>certified</i> have limits; the others are shown as they fail. Point at
a cell for all figures.</p>
)";

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '<' ? "&lt;" : c == '&' ? "&amp;" : c == '"' ? "&quot;" : std::string(1, c);
  return result;
}

/// From green (nothing) over yellow to red (10^0), by the logarithm down to 10^lowest.
std::string colour(double value, double lowest) {
  if (!(value > 0)) return "#cfe8cf";
  const double heat = std::clamp(1 - std::log10(value) / lowest, 0.0, 1.0);
  return fmt::format("hsl({:.0f} 85% {:.0f}%)", 55 - 55 * heat, 80 - 25 * heat);
}

/// What the decisions of a row are judged by: see how_to_read.
std::uint64_t unexcused(const StressRow& row) {
  return row.precision == Precision::robust ? row.wrong() - std::min(row.wrong(), row.errors.ambiguous) : row.wrong();
}

double wrong_share(const StressRow& row) {
  return static_cast<double>(unexcused(row)) / static_cast<double>(std::max<std::uint64_t>(row.errors.rays, 1));
}

std::string all_figures(const StressRow& r) {
  const Comparison& e = r.errors;
  return fmt::format(
      "{} {} on {} {}: {} rays, {} false hits, {} false misses, {} wrong ids, {} of these ambiguous, {} beyond bounds, "
      "{} "
      "bound violations, {} NaN; errors max / p99.9: t {:.2g} / {:.2g}, point {:.2g} / {:.2g}, normal {:.2g} / "
      "{:.2g}{}",
      r.tracer, to_string(r.precision), r.family, r.variant, e.rays, e.false_hits, e.false_misses, e.wrong_ids,
      e.ambiguous, e.beyond_bounds, e.bound_violations, e.nans, e.max_t_error, e.p999_t_error, e.max_point_error,
      e.p999_point_error, e.max_normal_error, e.p999_normal_error,
      r.broken.empty() ? "" : ". LIMIT BROKEN: " + r.broken);
}

/// A quantity that a map shows, and the power of ten where its colours end.
struct Metric {
  double (*of)(const StressRow&);
  double lowest;
};
constexpr Metric decisions{wrong_share, -6};
constexpr Metric distances{[](const StressRow& r) { return r.errors.p999_t_error; }, -16};

std::string cell(const StressRow& row, const Metric& metric) {
  const double value = metric.of(row);
  const std::string text = row.aborted ? "abort" : value == 0 ? "0" : fmt::format("{:.1e}", value);
  return fmt::format("<td{} style=\"background:{}\" title=\"{}\">{}</td>",
                     row.broken.empty() ? "" : " class=\"broken\"", colour(row.aborted ? 1 : value, metric.lowest),
                     escaped(all_figures(row)), text);
}

struct Column {
  std::string tracer;
  Precision precision;
  bool holds(const StressRow& row) const { return row.tracer == tracer && row.precision == precision; }
};

std::vector<Column> columns_of(const std::vector<StressRow>& rows) {
  std::vector<Column> columns;
  for (const StressRow& row : rows)
    if (std::ranges::none_of(columns, [&](const Column& c) { return c.holds(row); }))
      columns.push_back({row.tracer, row.precision});
  return columns;
}

/// One line for each label, in the order of the rows; `label` names a row's line.
template <class Label>
std::string map(const std::vector<StressRow>& rows, const std::vector<Column>& columns, const Metric& metric,
                const Label& label) {
  std::string text = "<table><tr><th></th>";
  for (const Column& c : columns) text += fmt::format("<th>{}<br>{}</th>", c.tracer, to_string(c.precision));
  text += "</tr>\n";
  for (std::size_t i = 0; i < rows.size();) {
    const std::string line = label(rows[i]);
    std::size_t end = i;
    while (end < rows.size() && label(rows[end]) == line) ++end;
    text += "<tr><th>" + escaped(line) + "</th>";
    for (const Column& c : columns) {
      const auto found = std::find_if(rows.begin() + i, rows.begin() + end, [&](auto& r) { return c.holds(r); });
      text += found == rows.begin() + end ? "<td class=\"none\">-</td>" : cell(*found, metric);
    }
    text += "</tr>\n";
    i = end;
  }
  return text + "</table>\n";
}

std::string family_label(const StressRow& row) { return fmt::format("{} {}", row.number, row.family); }

std::string variants(const StressReport& report, const std::vector<Column>& columns) {
  std::string text = "<h2>Wrong decisions, case by case</h2>\n";
  for (const stability::Family& family : stability::families()) {
    std::vector<StressRow> rows;
    for (const StressRow& row : report.rows)
      if (row.number == family.row) rows.push_back(row);
    if (rows.empty()) continue;
    text += fmt::format("<details><summary>{} {}: {}</summary>\n{}</details>\n", family.row, family.name, family.about,
                        map(rows, columns, decisions, [](const StressRow& r) { return r.variant; }));
  }
  return text;
}

std::string limits(const StressReport& report) {
  std::string text = "<h2>Limits</h2>\n<ul>\n";
  for (const std::string& error : report.oracle_errors)
    text += "<li>The oracle is wrong: " + escaped(error) + "</li>\n";
  for (const StressRow& row : report.rows)
    if (!row.broken.empty())
      text += fmt::format("<li>{} {} on {}, {}: {}</li>\n", row.tracer, to_string(row.precision), row.family,
                          escaped(row.variant), row.broken);
  return text + (report.good() ? "<li>All hold.</li>\n</ul>\n" : "</ul>\n");
}

}  // namespace

std::string stress_page(const StressReport& report, const Json& device) {
  const std::vector<StressRow> families = by_family(report.rows);
  const std::vector<Column> columns = columns_of(families);
  std::string text = head;
  text += fmt::format("<p>{}, {} threads, {}</p>\n", escaped(device["processor"].get<std::string>()),
                      device["threads"].get<int>(), device["isa"].get<std::string>());
  text += how_to_read;
  text += "<h2>Wrong decisions</h2>\n" + map(families, columns, decisions, family_label);
  text += "<h2>Relative error of t, 99.9th percentile, where ids are right</h2>\n" +
          map(families, columns, distances, family_label);
  return text + variants(report, columns) + limits(report) + "</body></html>\n";
}

}  // namespace rayengine::cli
