#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "accel/bvh.h"
#include "accel/geometry.h"

namespace rayengine {

/// A box by its middle and half its sides.
struct Voxel {
  glm::dvec3 center, half;
};

/// Whether a triangle meets a box: false only when it does not. Source: Akenine-Moeller, "Fast 3D Triangle-Box Overlap
/// Testing" (Journal of Graphics Tools 6(1), 2001), by separating axes.
bool overlaps(const std::array<glm::dvec3, 3>& corners, const Voxel& voxel);

/// The surface of a quadric in the coordinates of a frame.
class QuadricSurface {
 public:
  QuadricSurface(const Geometry& geometry, const Quadric& quadric, const LocalFrame& frame);

  /// Whether the clipped side or a cap can meet a box: false only when they do not. The form is bounded over the box by
  /// its value, gradient and second derivatives in the middle, so that what is inside or outside of the surface is
  /// left out.
  bool overlaps(const Voxel& voxel) const;

 private:
  bool meets_caps(double z, double half_z, double lowest_form) const;

  glm::dmat3 to_object_;  ///< of vectors
  glm::dvec3 origin_;     ///< of object space, in the frame
  glm::dmat3 quadratic_;  ///< the form in object space: p Q p + 2 q p + r
  glm::dvec3 linear_;
  double constant_;
  Box clip_;  ///< in object space
  bool capped_;
};

}  // namespace rayengine
