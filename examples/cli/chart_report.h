#pragma once

#include <string>
#include <vector>

#include "engine/measure/chart.h"
#include "examples/cli/report.h"

// How speed against accuracy is told: CSV, JSON, gnuplot, and a page.
namespace rayengine::cli {

struct SceneChart {
  std::string name;
  std::vector<ChartRow> rows;
};

std::string chart_csv(const std::vector<SceneChart>& scenes);
std::string distance_csv(const std::vector<DistanceRow>& rows);
Json chart_json(const std::vector<SceneChart>& scenes, const std::vector<DistanceRow>& distances);

/// Commands for draw_chart().
std::string chart_commands(const SceneChart& scene);
std::string distance_commands(const std::vector<DistanceRow>& rows);

/// Whether exact quadrics beat every tessellation, in a sentence or a few; empty where there are none.
std::string verdict(const std::vector<ChartRow>& rows);

/// The page that shows and explains the charts; without images when they were not drawn.
std::string chart_page(const std::vector<SceneChart>& scenes, const Json& device, bool drawn);

}  // namespace rayengine::cli
