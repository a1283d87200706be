#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "accel/ray.h"

namespace rayengine {

/// The precision ladder: what a tracer promises of its answers.
enum class Precision {
  half,       ///< 16-bit packed streams, GPU only
  fast,       ///< textbook single precision formulas
  robust,     ///< shifted quadratic with stable roots, watertight triangles, conservative boxes; quadrics in double
  certified,  ///< robust, with a proven bound on every t and ids equal to those of exact arithmetic
};

std::string_view to_string(Precision precision);
std::optional<Precision> parse_precision(std::string_view name);

/// What the making of an acceleration structure may take: time that its rays save again, if they are many. `none`:
/// there is none, and each ray is tested against all primitives.
enum class Build { thorough, quick, none };

/// What a caller must know to feed a tracer well.
struct Limits {
  bool concurrent = true;         ///< queries may come from several threads at once
  std::size_t batch = 4096;       ///< rays per query that use the device well
  double triangle_roundoff = 0;   ///< unit round-off of the arithmetic that tests triangles (2^-24, 2^-53, 0 if exact)
  double quadric_roundoff = 0;    ///< the same for quadrics
  double clearance_roundoff = 0;  ///< if larger: rays that leave surfaces should clear what that hides, for speed
  bool cuts = false;              ///< cuts large queries itself, and does best with all rays at once
};

/// Anything that answers ray queries on one Geometry, fixed when it was made.
///
/// Every query takes rays and writes one answer per ray, in the same order; the two spans have equal length, which is
/// checked. Invalid rays (see is_valid) get status_invalid and a miss, never an exception.
class Tracer {
 public:
  virtual ~Tracer() = default;

  virtual std::string_view name() const = 0;
  virtual Precision precision() const = 0;
  virtual Limits limits() const = 0;

  /// Seconds spent building the acceleration structure, and the bytes that it and its copies of the geometry take.
  virtual double build_seconds() const = 0;
  virtual std::size_t bytes() const = 0;

  /// Rays of all queries so far that had to be decided in more than the tracer's own arithmetic.
  virtual std::uint64_t resolved_rays() const { return 0; }

  /// The nearest hit of each ray. Equal t: the lowest object id, then the lowest primitive id.
  virtual void closest(std::span<const Ray> rays, std::span<Hit> hits, RayClass ray_class) = 0;

  /// Whether each ray hits anything at all: status_hit, status_miss or status_invalid.
  virtual void any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) = 0;

  /// Every hit of each ray, sorted by t, then object, then primitive.
  virtual HitLists all(std::span<const Ray> rays) = 0;
};

/// Throws Error unless a query has room for as many answers as it has rays.
void check_lengths(std::size_t rays, std::size_t answers);

/// A failure that its user can mend: `what()` is one line that says what, where (file:line) and what to do.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace rayengine
