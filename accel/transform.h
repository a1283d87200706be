#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace rayengine {

/// An affine map, object to world: p -> linear * p + origin. Columns of `linear` are the images of the axes.
struct Affine {
  glm::dmat3 linear{1};
  glm::dvec3 origin{0};

  glm::dvec3 point(const glm::dvec3& p) const { return linear * p + origin; }
  glm::dvec3 vector(const glm::dvec3& v) const { return linear * v; }

  static Affine translate(const glm::dvec3& by);
  static Affine scale(const glm::dvec3& by);
  /// Right-handed turn by `degrees` about `axis`, which need not have unit length. Throws Error when it is zero.
  static Affine rotate(const glm::dvec3& axis, double degrees);
};

/// First `b`, then `a`.
Affine operator*(const Affine& a, const Affine& b);

/// The inverse of an affine map, in the order that keeps accuracy far from the world's origin: first subtract, then
/// turn.
struct WorldToObject {
  glm::dmat3 linear{1};
  glm::dvec3 origin{0};

  glm::dvec3 point(const glm::dvec3& p) const { return linear * (p - origin); }
  glm::dvec3 vector(const glm::dvec3& v) const { return linear * v; }
  /// Takes an object-space normal to world space; not normalised.
  glm::dvec3 normal_to_world(const glm::dvec3& n) const { return n * linear; }
};

/// Throws Error when the map is singular or has entries that are not finite.
WorldToObject inverse(const Affine& map);

/// The map back.
Affine object_to_world(const WorldToObject& map);

}  // namespace rayengine
