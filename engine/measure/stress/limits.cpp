#include "engine/measure/stress/limits.h"

#include <algorithm>

namespace rayengine::stability {
namespace {

constexpr double in_double = 0x1p-53;
constexpr double near = 1e4, far = 1e7;  // distance over size
constexpr double share_when_near = 1e-6;

std::string count(std::uint64_t n, const char* what) { return std::to_string(n) + " " + what; }

std::string broken_by_certified(const StressRow& row) {
  return row.wrong() > 0 ? count(row.wrong(), "wrong decisions where none is allowed") : "";
}

/// Random rays from afar: what single precision has rounded away is not asked of it.
std::string broken_from_afar(const StressRow& row, const Case& from, const Limits& limits) {
  if (from.distance == 0 || from.distance > far) return {};
  const bool exact_enough = limits.quadric_roundoff <= in_double;
  if (from.distance > near) {
    return exact_enough && row.wrong() > 0 ? count(row.wrong(), "wrong decisions at distances up to 1e7") : "";
  }
  const std::uint64_t wrong = exact_enough ? row.wrong() : row.wrong() - std::min(row.wrong(), row.errors.ambiguous);
  const double allowed = share_when_near * static_cast<double>(row.errors.rays);
  return static_cast<double>(wrong) > allowed ? count(wrong, "wrong decisions at distances up to 1e4") : "";
}

std::string broken_by_robust(const StressRow& row, const Case& from, const Limits& limits) {
  if (from.closed && limits.triangle_roundoff <= in_double && row.errors.false_misses > 0)
    return count(row.errors.false_misses, "leaks through a closed mesh");
  return broken_from_afar(row, from, limits);
}

}  // namespace

std::string broken_limit(const StressRow& row, const Case& from, const Limits& limits) {
  if (row.aborted) return "the process was aborted";
  if (from.invalid && row.errors.beyond_bounds > 0)
    return count(row.errors.beyond_bounds, "invalid rays that were not answered as such");
  if (row.precision != Precision::robust && row.precision != Precision::certified) return {};
  if (row.errors.nans > 0) return count(row.errors.nans, "answers that are NaN");
  if (row.errors.bound_violations > 0) return count(row.errors.bound_violations, "errors above the stated bound");
  return row.precision == Precision::certified ? broken_by_certified(row) : broken_by_robust(row, from, limits);
}

}  // namespace rayengine::stability
