#pragma once

#include <cmath>
#include <glm/geometric.hpp>

#include "accel/geometry.h"
#include "accel/norms.h"
#include "accel/ray.h"
#include "accel/solve_formulas.h"

// A hit's primitive solved again in double, with a running bound on every rounding. Shared by surface.cpp and the two
// kinds of primitives; not for callers.
namespace rayengine {

inline formulas::Vec<double> kernel_vec(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
inline glm::dvec3 glm_vec(const formulas::Vec<double>& v) { return {v.x, v.y, v.z}; }

/// A vector's direction, and one over its length. Zero has the direction zero, and an infinite second.
struct Direction {
  glm::dvec3 unit;
  double per_length;
};

inline Direction normalised(const glm::dvec3& v) {
  const double square = glm::dot(v, v);
  if (formulas::is_regular(square)) {
    const double per_length = 1 / std::sqrt(square);
    return {per_length * v, per_length};
  }
  const double scale = largest_component(v);  // squares would vanish or overflow
  if (!(scale > 0)) return {glm::dvec3(0), std::numeric_limits<double>::infinity()};
  const glm::dvec3 w = v / scale;
  const double length = glm::length(w);
  return {w / length, 1 / length / scale};
}

inline glm::dvec3 unit(const glm::dvec3& v) { return normalised(v).unit; }

/// A ray in the space of the primitive's geometry.
using GroupRay = formulas::LocalRay<double>;

inline formulas::Map<double> map_of(const WorldToObject& map) {
  return {kernel_vec(map.linear[0]), kernel_vec(map.linear[1]), kernel_vec(map.linear[2]), kernel_vec(map.origin)};
}

struct Solution {
  double t = 0;
  double error = 0;                  ///< bound on |t - exact t|
  double distance = 0;               ///< bound on the distance of the point at t from the surface
  glm::dvec3 normal{0};              ///< unit, in world space
  glm::dvec2 barycentrics{0};        ///< of a triangle
  double magnitude = 0, spread = 0;  ///< as in Surface
};

/// The crossing with the triangle's plane; at `t_guess` where it is seen edge-on.
Solution solve_triangle(const PrimitiveRef& ref, const GroupRay& ray, double t_guess);

/// The crossing with a quadric's side that `t_guess` is nearest to, or with the plane of its cap.
Solution solve_quadric(const PrimitiveRef& ref, const GroupRay& ray, double t_guess);

/// A quadric's solution with the bits of t that tracers in double find: those of balls and cylinders without caps come
/// from kernels of their own.
Solution with_traced_t(const PrimitiveRef& ref, const GroupRay& ray, Solution solution);

/// A normal of the geometry that holds the primitive, taken to world space; not normalised.
inline glm::dvec3 to_world(const Instance* instance, const glm::dvec3& normal) {
  return instance ? instance->to_group.normal_to_world(normal) : normal;
}

}  // namespace rayengine
