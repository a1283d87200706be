#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "accel/quadric.h"

namespace rayengine::surfaces {

/// The lines along which distance from a quadric is measured in its object space.
enum class Fibres { central, radial, vertical };

/// A tube goes round its axis; whatever has a point on its axis is seen from above.
inline Fibres fibres_of(QuadricType type, double lower_clip) {
  switch (type) {
    case QuadricType::sphere: return Fibres::central;
    case QuadricType::cylinder:
    case QuadricType::hyperboloid1: return Fibres::radial;
    case QuadricType::cone: return lower_clip > 0 ? Fibres::radial : Fibres::vertical;
    default: return Fibres::vertical;
  }
}

/// The direction of the fibre through a point, toward the unit primitive's outside.
inline glm::dvec3 fibre(QuadricType type, Fibres fibres, const glm::dvec3& p) {
  switch (fibres) {
    case Fibres::central: return p;
    case Fibres::radial: return {p.x, p.y, 0};
    default: return {0, 0, type == QuadricType::plane || type == QuadricType::disk ? 1 : -1};
  }
}

/// A tube's radius, a convex function of the height, and its slope.
struct Radius {
  QuadricType type;
  double at(double z) const {
    return type == QuadricType::cylinder ? 1 : type == QuadricType::cone ? z : std::sqrt(1 + z * z);
  }
  double slope(double z) const {
    return type == QuadricType::cylinder ? 0 : type == QuadricType::cone ? 1 : z / std::sqrt(1 + z * z);
  }
};

/// The radius at height z, zero where there is nothing.
inline double section_radius(QuadricType type, double z) {
  switch (type) {
    case QuadricType::cone: return std::max(z, 0.);
    case QuadricType::paraboloid: return std::sqrt(std::max(z, 0.));
    case QuadricType::hyperboloid1: return std::sqrt(1 + z * z);
    case QuadricType::hyperboloid2: return std::sqrt(std::max(z * z - 1, 0.));
    default: return 1;
  }
}

/// A dome's or plate's height: the difference of two convex functions, `up` - `down`, and their gradients.
struct Height {
  QuadricType type;

  double up(const glm::dvec3& p) const {
    const double rr = p.x * p.x + p.y * p.y;
    switch (type) {
      case QuadricType::cone: return std::sqrt(rr);
      case QuadricType::paraboloid: return rr;
      case QuadricType::hyperboloid2: return std::sqrt(1 + rr);
      case QuadricType::saddle: return p.x * p.x;
      default: return 0;
    }
  }
  double down(const glm::dvec3& p) const { return type == QuadricType::saddle ? p.y * p.y : 0; }

  glm::dvec3 up_gradient(const glm::dvec3& p) const {
    const glm::dvec3 across(p.x, p.y, 0);
    switch (type) {
      case QuadricType::cone: return up(p) > 0 ? across / up(p) : glm::dvec3(0);
      case QuadricType::paraboloid: return 2. * across;
      case QuadricType::hyperboloid2: return across / up(p);
      case QuadricType::saddle: return {2 * p.x, 0, 0};
      default: return glm::dvec3(0);
    }
  }
  glm::dvec3 down_gradient(const glm::dvec3& p) const { return {0, type == QuadricType::saddle ? 2 * p.y : 0, 0}; }
  /// The height's largest slope up to `x` and `y` from the axis.
  double steepest(double x, double y) const {
    const glm::dvec3 p(x, y, 0);
    return glm::length(up_gradient(p)) + glm::length(down_gradient(p));
  }
};

}  // namespace rayengine::surfaces
