#include "examples/cli/stress_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "examples/cli/errors.h"

namespace rayengine::cli {
namespace {

bool same_cell(const StressRow& a, const StressRow& b) {
  return a.number == b.number && a.tracer == b.tracer && a.precision == b.precision;
}

/// Errors of points in sizes of what is hit, so that they can be put together.
StressRow in_sizes(StressRow row) {
  row.errors.max_point_error /= row.size;
  row.errors.p999_point_error /= row.size;
  row.size = 1;
  return row;
}

void add(Comparison& sum, const Comparison& c) {
  for (const auto count : {&Comparison::rays, &Comparison::hits, &Comparison::wrong_ids, &Comparison::false_hits,
                           &Comparison::false_misses, &Comparison::ambiguous, &Comparison::beyond_bounds,
                           &Comparison::bound_violations, &Comparison::nans})
    sum.*count += c.*count;
  for (const auto error :
       {&Comparison::max_t_error, &Comparison::p999_t_error, &Comparison::max_point_error,
        &Comparison::p999_point_error, &Comparison::max_normal_error, &Comparison::p999_normal_error})
    sum.*error = std::max(sum.*error, c.*error);
}

Json row_json(const StressRow& row) {
  const StressRow r = in_sizes(row);
  const Comparison& e = r.errors;
  Json json = {{"number", r.number},
               {"case", r.family},
               {"variant", r.variant},
               {"tracer", r.tracer},
               {"precision", to_string(r.precision)},
               {"aborted", r.aborted}};
  json.update(errors_json(e));
  json.update(details_json(e));
  json.erase("ulps");
  json.update({{"max_point_error", e.max_point_error},
               {"p999_point_error", e.p999_point_error},
               {"max_normal_error", e.max_normal_error},
               {"p999_normal_error", e.p999_normal_error},
               {"bound_violations", e.bound_violations},
               {"broken_limit", r.broken}});
  return json;
}

std::string two(double max, double p999) { return fmt::format("{:.1e}/{:.1e}", max, p999); }

/// What the table says of a row, beyond which case it is.
std::string line(const StressRow& row) {
  const Comparison& e = row.errors;
  std::string text = fmt::format("{:<10} {:<9} ", row.tracer, to_string(row.precision));
  if (row.aborted)
    text += "aborts the process";
  else
    text += fmt::format("{:>8} {:>7} {:>7} {:>7} {:>7} {:>7} {:>6} {:>4} {:<15} {:<15} {}", e.rays, e.false_hits,
                        e.false_misses, e.wrong_ids, e.ambiguous, e.beyond_bounds, e.bound_violations, e.nans,
                        two(e.max_t_error, e.p999_t_error), two(e.max_point_error, e.p999_point_error),
                        two(e.max_normal_error, e.p999_normal_error));
  return text + (row.broken.empty() ? "\n" : "  LIMIT BROKEN\n");
}

/// All families of a tracer at a precision together.
std::vector<StressRow> in_all(std::vector<StressRow> families) {
  for (StressRow& row : families) row.number = 0;
  return by_family(families);
}

}  // namespace

std::vector<StressRow> by_family(const std::vector<StressRow>& rows) {
  std::vector<StressRow> families;
  for (const StressRow& row : rows) {
    const StressRow one = in_sizes(row);
    const auto found = std::ranges::find_if(families, [&](const StressRow& f) { return same_cell(f, one); });
    if (found == families.end()) {
      families.push_back(one);
      families.back().variant.clear();
      continue;
    }
    add(found->errors, one.errors);
    found->aborted |= one.aborted;
    if (found->broken.empty()) found->broken = one.broken;
  }
  return families;
}

std::string stress_table(const std::vector<StressRow>& families) {
  std::string text =
      fmt::format("{:<23} {:<10} {:<9} {:>8} {:>7} {:>7} {:>7} {:>7} {:>7} {:>6} {:>4} {:<15} {:<15} {}\n", "case",
                  "tracer", "precision", "rays", "hits+", "misses+", "ids", "ambig.", "beyond", "bounds", "NaN",
                  "t max/p99.9", "point", "normal");
  for (const StressRow& row : families) text += fmt::format("{:>2} {:<20} ", row.number, row.family) + line(row);
  for (const StressRow& row : in_all(families)) text += fmt::format("{:<23} ", "all of them") + line(row);
  return text;
}

Json stress_json(const StressReport& report) {
  Json rows = Json::array();
  for (const StressRow& row : report.rows) rows.push_back(row_json(row));
  return {{"good", report.good()},
          {"oracle_errors", report.oracle_errors},
          {"left_out", report.left_out},
          {"refused", report.refused},
          {"rows", rows}};
}

}  // namespace rayengine::cli
