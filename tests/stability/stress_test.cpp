// The stability suite, small: `rayengine stress` runs it with more rays and tells more.

#include "engine/measure/stress/stress.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "engine/measure/stress/limits.h"
#include "engine/tracers.h"

namespace rayengine {
namespace {

/// Whose summary begins with the device.
std::vector<std::string> tracers_on(std::string_view device) {
  std::vector<std::string> names;
  for (const TracerInfo& info : tracer_list())
    if (info.summary.starts_with(device) && info.name != "reference") names.emplace_back(info.name);
  return names;
}

void expect_good(const StressReport& report) {
  for (const StressRow& row : report.rows)
    EXPECT_EQ(row.broken, "") << row.tracer << " at " << to_string(row.precision) << " on " << row.family << ", "
                              << row.variant;
  for (const std::string& error : report.oracle_errors) ADD_FAILURE() << "the oracle is wrong: " << error;
}

TEST(Stress, TracersOnTheProcessorKeepTheirLimits) {
  const StressReport report =
      stress({.tracers = tracers_on("CPU:"), .precisions = {Precision::robust, Precision::certified}, .rays = 60'000});
  expect_good(report);
  std::set<int> seen;
  for (const StressRow& row : report.rows) seen.insert(row.number);
  for (int number = 1; number <= 34; ++number) EXPECT_TRUE(seen.contains(number)) << "row " << number;
}

TEST(Stress, CertifiedDecidesAMillionRaysRight) {
  const StressReport report = stress({.tracers = {"bvh"}, .precisions = {Precision::certified}, .rays = 1'000'000});
  expect_good(report);
  std::uint64_t rays = 0;
  for (const StressRow& row : report.rows) rays += row.errors.rays;
  EXPECT_GT(rays, 900'000u);
}

/// Every tracer is made anew for each case, which takes a GPU's ten times as long as the rays: some families have to
/// do.
TEST(Stress, TracersOnTheGpuKeepTheirLimits) {
  StressOptions options{.tracers = tracers_on("GPU:"),
                        .precisions = {Precision::robust, Precision::certified},
                        .families = {"shared edges", "coplanar", "bad input", "agreement"},
                        .rays = 10'000};
  try {
    expect_good(stress(options));
  } catch (const Error& error) {
    GTEST_SKIP() << error.what();
  }
}

TEST(Stress, PrecisionsThatFailAreSeenToFail) {
  const StressReport report = stress({.tracers = {"embree"},
                                      .precisions = {Precision::fast},
                                      .families = {"far", "shared edges", "slivers"},
                                      .rays = 20'000});
  std::uint64_t far = 0, leaks = 0;
  for (const StressRow& row : report.rows)
    (row.family == "far" ? far : leaks) += row.family == "far" ? row.wrong() : row.errors.false_misses;
  EXPECT_GT(far, 100u);
  EXPECT_GT(leaks, 100u);
  EXPECT_TRUE(report.good()) << "nothing is asked of 'fast'";
}

TEST(Stress, NamesWhatCannotBeMade) {
  const StressReport report = stress({.tracers = {"embree"},
                                      .precisions = {Precision::half, Precision::robust},
                                      .families = {"coplanar"},
                                      .rays = 20});
  ASSERT_EQ(report.left_out.size(), 1u);
  EXPECT_NE(report.left_out[0].find("half"), std::string::npos);
  EXPECT_THROW(stress({.tracers = {"embree"}, .precisions = {Precision::half}}), Error);
}

TEST(Stress, OneThatAbortsIsNotAsked) {
  const StressReport report = stress({.tracers = {"embree"},
                                      .precisions = {Precision::robust},
                                      .families = {"coplanar"},
                                      .rays = 20,
                                      .aborts = [](const std::string&, Precision) { return true; }});
  ASSERT_EQ(report.rows.size(), 2u);
  EXPECT_TRUE(report.rows[0].aborted);
  EXPECT_EQ(report.rows[0].errors.rays, 0u);
  EXPECT_FALSE(report.good());
}

bool same(const Ray& a, const Ray& b) {
  return a.origin == b.origin && a.direction == b.direction && a.tmin == b.tmin && a.tmax == b.tmax;
}

TEST(StressFamilies, MakeTheSameRaysFromTheSameSeedAndMoreThatBeginWithTheFewer) {
  for (const stability::Family& family : stability::families()) {
    const auto few = family.make(12, 7), again = family.make(12, 7), other = family.make(12, 8);
    ASSERT_EQ(few.size(), again.size()) << family.name;
    ASSERT_FALSE(few.empty()) << family.name;
    std::size_t differs = 0;
    for (std::size_t i = 0; i < few.size(); ++i) {
      ASSERT_EQ(few[i].rays.size(), again[i].rays.size()) << family.name;
      EXPECT_GE(few[i].rays.size(), 1u) << family.name << ", " << few[i].variant;
      for (std::size_t k = 0; k < few[i].rays.size(); ++k) {
        const bool nan = !is_valid(few[i].rays[k]);  // is not even the same as itself
        EXPECT_TRUE(nan || same(few[i].rays[k], again[i].rays[k])) << family.name;
        differs += !same(few[i].rays[k], other[i].rays[k]);
      }
    }
    EXPECT_GT(differs, 0u) << family.name;
  }
}

TEST(StressFamilies, AreTheTablesRowsAndNamedOnce) {
  std::set<std::string_view> names;
  int row = 0;
  for (const stability::Family& family : stability::families()) {
    EXPECT_EQ(family.row, ++row);
    names.insert(family.name);
  }
  EXPECT_EQ(names.size(), stability::families().size());
}

/// What a limit says of a row that a change has spoilt.
std::string broken(Precision precision, const stability::Case& from, const Limits& limits,
                   const std::function<void(StressRow&)>& spoil) {
  StressRow row;
  row.precision = precision;
  row.errors.rays = 1'000'000;
  spoil(row);
  return stability::broken_limit(row, from, limits);
}

const Limits in_double{.triangle_roundoff = 0x1p-53, .quadric_roundoff = 0x1p-53};
const Limits in_single{.triangle_roundoff = 0x1p-24, .quadric_roundoff = 0x1p-24};

TEST(StressLimits, CertifiedIsAllowedNothing) {
  const auto spoilt = [](const auto& spoil) { return broken(Precision::certified, {}, in_single, spoil); };
  EXPECT_EQ(spoilt([](StressRow&) {}), "");
  EXPECT_NE(spoilt([](StressRow& r) { r.errors.wrong_ids = 1; }), "");
  EXPECT_NE(spoilt([](StressRow& r) { r.errors.false_hits = 1; }), "");
  EXPECT_NE(spoilt([](StressRow& r) { r.errors.false_misses = 1; }), "");
  EXPECT_NE(spoilt([](StressRow& r) { r.errors.bound_violations = 1; }), "");
  EXPECT_NE(spoilt([](StressRow& r) { r.errors.nans = 1; }), "");
  EXPECT_NE(spoilt([](StressRow& r) { r.aborted = true; }), "");
}

TEST(StressLimits, RobustIsAllowedOneInAMillionFromNearAndNoneFromFar) {
  const auto wrong = [](double distance, std::uint64_t n, const Limits& limits) {
    return broken(Precision::robust, {.distance = distance}, limits, [=](StressRow& r) { r.errors.false_hits = n; });
  };
  EXPECT_EQ(wrong(1e4, 1, in_double), "");
  EXPECT_NE(wrong(1e4, 2, in_double), "");
  EXPECT_NE(wrong(1e4, 2, in_single), "");
  EXPECT_NE(wrong(1e7, 1, in_double), "");
  EXPECT_EQ(wrong(1e7, 1, in_single), "") << "single precision cannot";
  EXPECT_EQ(wrong(0, 1000, in_double), "") << "no random rays from afar";
}

TEST(StressLimits, RobustInDoubleLeaksNothing) {
  const auto leak = [](const Limits& limits) {
    return broken(Precision::robust, {.closed = true}, limits, [](StressRow& r) { r.errors.false_misses = 1; });
  };
  EXPECT_NE(leak(in_double), "");
  EXPECT_EQ(leak(in_single), "");
}

TEST(StressLimits, InvalidRaysAreHeldAgainstEveryPrecision) {
  for (const Precision precision : {Precision::half, Precision::fast, Precision::robust})
    EXPECT_NE(broken(precision, {.invalid = true}, in_single, [](StressRow& r) { r.errors.beyond_bounds = 1; }), "");
  EXPECT_EQ(broken(Precision::fast, {}, in_single, [](StressRow& r) { r.errors.nans = r.errors.wrong_ids = 9; }), "");
}

}  // namespace
}  // namespace rayengine
