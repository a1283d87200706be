#include "examples/cli/errors.h"

#include <fmt/format.h>

namespace rayengine::cli {
namespace {

/// Bins hold 0, 1, 2, 3-4, 5-8, ... ulps.
std::string bin_name(std::size_t bin) {
  if (bin < 3) return std::to_string(bin);
  const std::uint64_t last = std::uint64_t{1} << (bin - 1);
  return fmt::format("{}-{}", last / 2 + 1, last);
}

}  // namespace

Json errors_json(const Comparison& c) {
  return {{"wrong_ids", c.wrong_ids},
          {"false_hits", c.false_hits},
          {"false_misses", c.false_misses},
          {"max_rel_t_error", c.max_t_error},
          {"ambiguous", c.ambiguous}};
}

Json details_json(const Comparison& c) {
  return {{"rays", c.rays},
          {"hits", c.hits},
          {"beyond_bounds", c.beyond_bounds},
          {"nans", c.nans},
          {"p999_rel_t_error", c.p999_t_error},
          {"ulps", c.ulps}};
}

std::string errors_header() {
  return fmt::format("{:>10} {:>10} {:>10} {:>11} {:>13} {:>10} {:>14} {:>12} {:>13}", "rays", "hits", "wrong ids",
                     "false hits", "false misses", "ambiguous", "beyond bounds", "max t error", "p99.9 t error");
}

std::string errors_row(const Comparison& c) {
  return fmt::format("{:>10} {:>10} {:>10} {:>11} {:>13} {:>10} {:>14} {:>12.3g} {:>13.3g}", c.rays, c.hits,
                     c.wrong_ids, c.false_hits, c.false_misses, c.ambiguous, c.beyond_bounds, c.max_t_error,
                     c.p999_t_error);
}

std::string histogram(const std::vector<std::uint64_t>& ulps) {
  std::string text;
  for (std::size_t bin = 0; bin < ulps.size(); ++bin)
    if (ulps[bin]) text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", bin_name(bin), count_text(ulps[bin]));
  return text.empty() ? "nothing to compare" : text;
}

}  // namespace rayengine::cli
