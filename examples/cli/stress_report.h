#pragma once

#include <string>
#include <vector>

#include "engine/measure/stress/stress.h"
#include "examples/cli/report.h"

// How the stability suite's results are told.
namespace rayengine::cli {

/// All cases of a family together: counts added up, errors the largest.
std::vector<StressRow> by_family(const std::vector<StressRow>& rows);

/// A line a family, and one for all families of each tracer and precision.
std::string stress_table(const std::vector<StressRow>& families);
Json stress_json(const StressReport& report);

/// A page with heat maps, that needs nothing else.
std::string stress_page(const StressReport& report, const Json& device);

}  // namespace rayengine::cli
