#pragma once

#include <span>
#include <vector>

#include "accel/geometry.h"
#include "accel/tracer.h"

namespace rayengine {

/// An answer that differs from the oracle's, or whose t differs by more than rounding explains on a plane surface.
struct Doubt {
  std::size_t index;  ///< of the ray in its batch
  Ray ray;
  Hit hit, exact;  ///< the tracer's answer and the oracle's
  double bound;    ///< how far rounding can move the ray where it hits: rounding_bound of the two
};

/// `bound` across the ray, as it shows in t on a plane surface with the normal of `hit`.
double in_t(double bound, const Ray& ray, const Hit& hit);

/// What the tracer may have seen instead of the ray: shifted across itself or turned about its origin, in eight
/// directions by this part of the bound, and its interval moved by the bound. Always the same number of rays.
std::vector<Ray> neighbours(const Doubt& doubt, double part);

/// Whether rounding within the bound can have led to the tracer's answer, given the oracle's answers to neighbours at
/// `part` of the bound.
/// A t must lie among theirs. A miss needs a neighbour that misses. A hit needs a surface that comes within the bound
/// of the ray, near the stated t, and not hidden from every neighbour: so rays that slip through a closed mesh and then
/// hit its far side are not excused, nor are ids of another triangle in the same plane.
bool explained(const Doubt& doubt, double part, std::span<const Hit> answers, const Geometry& geometry, Tracer& oracle);

}  // namespace rayengine
