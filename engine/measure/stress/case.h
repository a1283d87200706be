#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "accel/geometry.h"
#include "accel/tracer.h"

// The stability suite: scenes with rays that are known to break ray tracers. docs/accuracy.md lists them.
namespace rayengine::stability {

/// What is known of one ray without asking the oracle.
struct Known {
  std::size_t ray;
  double t;              ///< infinity: a miss
  double tolerance = 0;  ///< relative
};

enum class Query { closest, any, all };

/// One scene with its rays: one value of what a family sweeps.
struct Case {
  std::string variant;
  std::shared_ptr<const Geometry> geometry;
  std::vector<Ray> rays;
  double size = 1;       ///< of what is hit: errors of points are told in it
  double distance = 0;   ///< of the rays' origins over `size`, where rays are random and sent from afar; else 0
  bool closed = false;   ///< every ray meets a surface without gaps: a miss is a leak
  bool invalid = false;  ///< every ray is one that no tracer may be asked
  std::vector<Known> known = {};
  Query query = Query::closest;
  RayClass ray_class = RayClass::bounce;
  /// Where set, answers are held against those that the same tracer gives here, and not against the oracle's.
  std::shared_ptr<const Case> twin = nullptr;
};

/// Cases of one kind. `make` gives every case some `rays` rays; the same seed gives the same ones.
struct Family {
  int row;  ///< of the table in docs/accuracy.md; beyond 28 are those that the table did not have
  std::string_view name;
  std::string_view about;
  std::vector<Case> (*make)(std::size_t rays, std::uint64_t seed);
};

std::span<const Family> families();

}  // namespace rayengine::stability
