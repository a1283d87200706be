#include "examples/cli/chart_report.h"

#include <fmt/format.h>

#include <algorithm>

namespace rayengine::cli {
namespace {

Json row_json(const std::string& scene, const ChartRow& r) {
  return {{"scene", scene},
          {"method", r.method},
          {"precision", to_string(r.precision)},
          {"tessellation", r.level},
          {"rays", r.rays},
          {"mrays_per_s", r.mrays_per_s},
          {"wrong_share", r.wrong_share()},
          {"median_rel_t_error", r.errors.median_t_error},
          {"max_rel_t_error", r.errors.max_t_error},
          {"rmse", r.rmse},
          {"build_s", r.build_seconds},
          {"bytes", r.bytes},
          {"pareto", r.fastest_so_accurate}};
}

Json row_json(const DistanceRow& r) {
  return {{"method", r.method},
          {"precision", r.precision ? to_string(*r.precision) : ""},
          {"distance", r.distance},
          {"wrong_share", r.wrong_share},
          {"max_t_error_in_radii", r.max_t_error},
          {"quadric_roundoff", r.quadric_roundoff}};
}

std::string text_of(const Json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

/// A line of names and one for each row.
std::string csv(const Json& rows) {
  std::string text;
  for (const Json& row : rows) {
    std::vector<std::string> names, values;
    for (const auto& [key, value] : row.items()) names.push_back(key), values.push_back(text_of(value));
    if (text.empty()) text = fmt::format("{}\n", fmt::join(names, ","));
    text += fmt::format("{}\n", fmt::join(values, ","));
  }
  return text;
}

Json rows_json(const std::vector<SceneChart>& scenes) {
  Json rows = Json::array();
  for (const SceneChart& scene : scenes)
    for (const ChartRow& row : scene.rows) rows.push_back(row_json(scene.name, row));
  return rows;
}

Json rows_json(const std::vector<DistanceRow>& distances) {
  Json rows = Json::array();
  for (const DistanceRow& row : distances) rows.push_back(row_json(row));
  return rows;
}

std::string called(const ChartRow& row) { return fmt::format("{} {}", row.method, to_string(row.precision)); }

/// No worse in every error, whatever the speed.
bool as_accurate(const ChartRow& a, const ChartRow& b) {
  return a.errors.median_t_error <= b.errors.median_t_error && a.wrong_share() <= b.wrong_share() && a.rmse <= b.rmse;
}

}  // namespace

std::string chart_csv(const std::vector<SceneChart>& scenes) { return csv(rows_json(scenes)); }
std::string distance_csv(const std::vector<DistanceRow>& rows) { return csv(rows_json(rows)); }

Json chart_json(const std::vector<SceneChart>& scenes, const std::vector<DistanceRow>& distances) {
  return {{"rows", rows_json(scenes)}, {"distance", rows_json(distances)}};
}

std::string verdict(const std::vector<ChartRow>& rows) {
  const ChartRow* exact = nullptr;  // the fastest
  for (const ChartRow& row : rows)
    if (row.level == 0 && (!exact || row.mrays_per_s > exact->mrays_per_s)) exact = &row;
  std::size_t tessellations = 0;
  std::vector<std::string> unbeaten;
  for (const ChartRow& tess : rows) {
    if (tess.level == 0) continue;
    ++tessellations;
    const bool beaten = std::ranges::any_of(rows, [&](const ChartRow& row) {
      return row.level == 0 && row.mrays_per_s > tess.mrays_per_s && as_accurate(row, tess);
    });
    if (!beaten && exact)
      unbeaten.push_back(fmt::format("{} ({:.2g} times the speed of {}, {:.2g} of the rays wrong)", called(tess),
                                     tess.mrays_per_s / exact->mrays_per_s, called(*exact), tess.wrong_share()));
  }
  if (tessellations == 0 || !exact) return {};
  if (unbeaten.empty()) return "Exact quadrics beat every tessellation in speed and in error at once.";
  return fmt::format("Not beaten in speed and error at once by exact quadrics: {}.", fmt::join(unbeaten, ", "));
}

}  // namespace rayengine::cli
