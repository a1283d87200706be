#include "accel/transform.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include "accel/tracer.h"

namespace rayengine {
namespace {

bool is_finite(const glm::dmat3& m) {
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row)
      if (!std::isfinite(m[column][row])) return false;
  return true;
}

}  // namespace

Affine Affine::translate(const glm::dvec3& by) { return {glm::dmat3(1), by}; }

Affine Affine::scale(const glm::dvec3& by) {
  Affine map;
  for (int i = 0; i < 3; ++i) map.linear[i][i] = by[i];
  return map;
}

Affine Affine::rotate(const glm::dvec3& axis, double degrees) {
  if (glm::dot(axis, axis) == 0) throw Error("a rotation's axis is zero: give it a direction");
  return {glm::dmat3(glm::rotate(glm::dmat4(1), glm::radians(degrees), axis)), glm::dvec3(0)};
}

Affine operator*(const Affine& a, const Affine& b) { return {a.linear * b.linear, a.point(b.origin)}; }

WorldToObject inverse(const Affine& map) {
  const WorldToObject result{glm::inverse(map.linear), map.origin};
  const bool finite_origin = std::isfinite(map.origin.x + map.origin.y + map.origin.z);
  if (!finite_origin || !is_finite(map.linear) || !is_finite(result.linear) || glm::determinant(map.linear) == 0)
    throw Error("a transform is singular or not finite: it must map space one to one");
  return result;
}

Affine object_to_world(const WorldToObject& map) { return {glm::inverse(map.linear), map.origin}; }

}  // namespace rayengine
