#include "engine/load/nff_cone.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "accel/frame.h"
#include "accel/tracer.h"

namespace rayengine {
namespace {

/// A right-handed frame whose third axis is `axis` itself and whose other two have the length `radius`.
glm::dmat3 frame(const glm::dvec3& axis, double radius) {
  const glm::dmat3 turn = frame_about(glm::normalize(axis));
  return {radius * turn[0], radius * turn[1], axis};
}

QuadricShape shape_of(QuadricType type) {
  QuadricShape shape;
  shape.type = type;
  return shape;
}

/// x^2 + y^2 = (1 + slope z)^2 for z in [0, 1], with a slope in (-1, 0). The sides of the box only bound it.
QuadricShape near_cylinder(double slope) {
  constexpr double beside = 1.001;
  QuadricShape shape = shape_of(QuadricType::general);
  shape.matrix = {1, 0, 0, 0, 1, 0, 0, -slope * slope, -slope, -1};
  shape.box = Box{{-beside, -beside, 0}, {beside, beside, 1}};
  return shape;
}

}  // namespace

PlacedQuadric frustum(const glm::dvec3& base, double base_radius, const glm::dvec3& apex, double apex_radius) {
  if (base_radius * apex_radius < 0) throw Error("the radii of a cone have different signs; give both the same");
  if (base_radius == 0 && apex_radius == 0) throw Error("a cone has no radius; give it one");
  glm::dvec3 wide = base, narrow = apex;
  double r = std::abs(base_radius), s = std::abs(apex_radius);
  if (r < s) std::swap(wide, narrow), std::swap(r, s);
  const glm::dvec3 axis = narrow - wide;
  if (!(glm::length(axis) > 0)) throw Error("a cone has no height; its two ends must differ");
  if (r == s) return {shape_of(QuadricType::cylinder), {frame(axis, r), wide}};

  // The apex is this many heights from the wide end: as many times larger are the numbers that the unit cone works
  // with.
  const double heights = r / (r - s);
  constexpr double far = 64;
  if (heights > far) return {near_cylinder(s / r - 1), {frame(axis, r), wide}};
  QuadricShape cone = shape_of(QuadricType::cone);
  cone.clip = {s / r, 1};
  return {cone, {frame(-heights * axis, r), wide + heights * axis}};
}

}  // namespace rayengine
