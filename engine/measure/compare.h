#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "accel/geometry.h"
#include "accel/tracer.h"

namespace rayengine {

/// What one tracer answered against the oracle, on the same rays.
struct Comparison {
  std::uint64_t rays = 0;
  std::uint64_t hits = 0;        ///< by the oracle
  std::uint64_t wrong_ids = 0;   ///< both hit, another object or primitive
  std::uint64_t false_hits = 0;  ///< a hit where the oracle misses
  std::uint64_t false_misses = 0;
  std::uint64_t ambiguous = 0;      ///< of those three: what the oracle itself answers to a ray moved within the bound
  std::uint64_t beyond_bounds = 0;  ///< not ambiguous, or |t - exact t| above the stated bound
  std::uint64_t bound_violations = 0;  ///< of those beyond bounds, where ids agree: |t - exact t| above Hit::error
  std::uint64_t nans = 0;
  double max_t_error = 0;  ///< relative to |t|, where ids agree
  double p999_t_error = 0;
  double median_t_error = 0;
  double max_point_error = 0;  ///< distance between the points of the ray at t, in world units, where ids agree
  double p999_point_error = 0;
  double max_normal_error = 0;  ///< angle between the normals in radians, where ids agree
  double p999_normal_error = 0;
  std::vector<std::uint64_t> ulps;  ///< histogram of differences in t, in float ulps: 0, 1, 2, 3-4, 5-8, ... doubling
  std::vector<std::size_t> first;   ///< indices of the first rays that are beyond bounds

  std::uint64_t wrong() const { return wrong_ids + false_hits + false_misses; }
};

/// Answers to rays by a tracer of these limits, and the exact ones; spans of equal length.
struct Answers {
  const Geometry& geometry;
  Limits limits;
  std::span<const Ray> rays;
  RayClass ray_class;
  std::span<const Hit> hits, exact;
};

/// What compare() says, of answers that were given before. Without an oracle to ask again, nothing is ambiguous: every
/// difference is beyond bounds, and a t is only where its hit states an error and breaks it.
Comparison judge(const Answers& answers, Tracer* oracle);

/// What a tracer cannot have answered: found again where it wrote nothing.
Hit unanswered();

/// Compares closest hits. `oracle` answers are taken as exact; rays that differ are asked again, shifted and turned by
/// the tracer's rounding (rounding_bound) in eight directions across the ray, and with their intervals moved, to see
/// whether the difference is one that rounding explains. Where a hit states its own error, its t must be within that.
Comparison compare(Tracer& tracer, Tracer& oracle, const Geometry& geometry, std::span<const Ray> rays,
                   RayClass ray_class);

}  // namespace rayengine
