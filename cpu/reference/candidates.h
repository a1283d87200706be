#pragma once

#include <vector>

#include "accel/geometry.h"
#include "cpu/reference/closed_meshes.h"
#include "cpu/reference/formulas.h"

namespace rayengine::reference {

/// A hit within the ray's interval, with what it takes to compare it exactly and to describe it.
struct Candidate {
  Crossing at;
  std::uint32_t object = no_id, primitive = no_id;  ///< as Hit has them
  const Geometry* geometry = nullptr;               ///< holds the primitive
  const Instance* instance = nullptr;               ///< null when it is not instanced
  std::uint32_t index = 0;                          ///< into the geometry's triangles or quadrics
  bool is_triangle = false;
};

/// Whether a crossing of a triangle or quadric lies in (tmin, tmax], exactly.
bool in_interval(const Ray& ray, const Candidate& candidate);

/// Negative when `a` comes first along the ray, 0 when both have the same t. Exact; but where a quadric takes part, and
/// a number on the way is beyond 2^1000 or below 2^-1000, 113 bits tell.
int compare_t(const Ray& ray, const Candidate& a, const Candidate& b);

/// compare_t, then object ids, then primitive ids.
bool before(const Ray& ray, const Candidate& a, const Candidate& b);

/// Whether the hit counts among all hits. Of closed meshes every crossing counts once, though it be at an edge or a
/// vertex (see owns_crossing), of capped quadrics though it be at a rim (see cross_quadric); of other meshes every
/// triangle that is touched.
bool owns(const Ray& ray, const Candidate& candidate, const ClosedMeshes& closed);

/// The answer, rounded to Hit's types, with a bound that covers the rounding of t.
Hit describe(const Ray& ray, const Candidate& candidate);

/// What a query does with hits as they are found, in any order.
class Sink {
 public:
  virtual ~Sink() = default;
  virtual void add(const Candidate& candidate) = 0;
  /// No hit beyond it can change the answer.
  virtual double reach() const = 0;
};

}  // namespace rayengine::reference
