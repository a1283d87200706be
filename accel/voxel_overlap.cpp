#include "accel/voxel_overlap.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace rayengine {
namespace {

/// Whether the triangle and the box are apart along an axis. Corners are relative to the box's middle.
bool apart(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& half, const glm::dvec3& axis) {
  const double a = glm::dot(corners[0], axis), b = glm::dot(corners[1], axis), c = glm::dot(corners[2], axis);
  const double reach = glm::dot(half, glm::abs(axis));
  return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
}

glm::dvec3 unit_axis(int i) {
  glm::dvec3 axis(0);
  axis[i] = 1;
  return axis;
}

/// What of object space a type's side can fill, before the matrix is looked at.
Box clip_box(const Geometry& geometry, const Quadric& q) {
  if (q.type == QuadricType::general) return geometry.forms[q.form].box;
  Box box{glm::dvec3(-infinity), glm::dvec3(infinity)};
  const bool square = q.type == QuadricType::saddle || q.type == QuadricType::disk;
  if (square) box.lower.x = box.lower.y = -1, box.upper.x = box.upper.y = 1;
  box.lower.z = q.type == QuadricType::saddle ? std::max(q.zmin, -1.) : q.zmin;
  box.upper.z = q.type == QuadricType::saddle ? std::min(q.zmax, 1.) : q.zmax;
  return box;
}

}  // namespace

bool overlaps(const std::array<glm::dvec3, 3>& corners, const Voxel& voxel) {
  const std::array<glm::dvec3, 3> c{corners[0] - voxel.center, corners[1] - voxel.center, corners[2] - voxel.center};
  const std::array<glm::dvec3, 3> edges{c[1] - c[0], c[2] - c[1], c[0] - c[2]};
  if (apart(c, voxel.half, glm::cross(edges[0], edges[1]))) return false;
  for (int i = 0; i < 3; ++i) {
    if (apart(c, voxel.half, unit_axis(i))) return false;
    for (const glm::dvec3& edge : edges)
      if (apart(c, voxel.half, glm::cross(unit_axis(i), edge))) return false;
  }
  return true;
}

QuadricSurface::QuadricSurface(const Geometry& geometry, const Quadric& q, const LocalFrame& frame)
    : to_object_(q.to_object.linear / frame.scale),
      origin_((q.to_object.origin - frame.center) * frame.scale),
      clip_(clip_box(geometry, q)),
      capped_(q.capped) {
  const QuadricMatrix& m = q.type == QuadricType::general ? geometry.forms[q.form].matrix : unit_matrix(q.type);
  quadratic_ = {{m[0], m[1], m[2]}, {m[1], m[4], m[5]}, {m[2], m[5], m[7]}};
  linear_ = {m[3], m[6], m[8]};
  constant_ = m[9];
}

bool QuadricSurface::overlaps(const Voxel& voxel) const {
  const glm::dvec3 p = to_object_ * (voxel.center - origin_);
  glm::dmat3 spread = to_object_;  // its columns: half the box's edges in object space
  for (int i = 0; i < 3; ++i) spread[i] *= voxel.half[i];
  const glm::dvec3 half = glm::abs(spread[0]) + glm::abs(spread[1]) + glm::abs(spread[2]);
  const glm::dvec3 lower = p - half, upper = p + half;
  if (glm::any(glm::lessThan(upper, clip_.lower)) || glm::any(glm::greaterThan(lower, clip_.upper))) return false;

  const glm::dvec3 gradient = quadratic_ * p + linear_;  // half of it
  const double form = glm::dot(p, gradient + linear_) + constant_;
  double reach = 0;
  for (int i = 0; i < 3; ++i) {
    reach += 2 * std::abs(glm::dot(gradient, spread[i]));
    for (int k = 0; k < 3; ++k) reach += std::abs(glm::dot(spread[i], quadratic_ * spread[k]));
  }
  return std::abs(form) <= reach || (capped_ && meets_caps(p.z, half.z, form - reach));
}

/// Caps fill what of their planes is not outside of the form.
bool QuadricSurface::meets_caps(double z, double half_z, double lowest_form) const {
  const auto near = [&](double plane) { return std::abs(z - plane) <= half_z; };
  return lowest_form <= 0 && (near(clip_.lower.z) || near(clip_.upper.z));
}

}  // namespace rayengine
