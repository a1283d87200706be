#pragma once

#include <string>

#include "engine/measure/compare.h"
#include "examples/cli/report.h"

// How comparisons are told, in tables and in JSON; `compare` and `bench` share it.
namespace rayengine::cli {

/// wrong_ids, false_hits, false_misses, max_rel_t_error, ambiguous.
Json errors_json(const Comparison& comparison);

/// What is counted beyond that: rays, hits, beyond_bounds, nans, p999_rel_t_error, and the histogram by float ulps.
Json details_json(const Comparison& comparison);

std::string errors_header();
std::string errors_row(const Comparison& comparison);

/// `0: 512, 1: 20, 3-4: 1`; empty bins are left out.
std::string histogram(const std::vector<std::uint64_t>& ulps);

}  // namespace rayengine::cli
