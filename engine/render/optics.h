#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "accel/kernels/kernels.h"
#include "engine/scene/scene.h"

// Directions have unit length and point along the light's or the ray's way; normals are unit and face the ray that
// comes in.
namespace rayengine {

inline glm::dvec3 reflected(const glm::dvec3& direction, const glm::dvec3& normal) {
  return direction - 2 * glm::dot(direction, normal) * normal;
}

/// Snell's law; `eta` is the refractive index before the surface over that behind it. None at total internal
/// reflection.
inline std::optional<glm::dvec3> refracted(const glm::dvec3& direction, const glm::dvec3& normal, double eta) {
  const double cosine = -glm::dot(direction, normal);
  const double squared = 1 - eta * eta * (1 - cosine * cosine);
  if (squared < 0) return std::nullopt;
  return eta * direction + (eta * cosine - std::sqrt(squared)) * normal;
}

/// The share of a light's colour that a surface sends to the eye: Lambert's cosine times its own colour, plus a
/// highlight of the light's colour.
inline glm::vec3 reflected_light(const Material& m, const glm::vec3& normal, const glm::vec3& to_light,
                                 const glm::vec3& view) {
  const float cosine = glm::dot(normal, to_light);
  glm::vec3 light = m.diffuse * cosine * m.color;
  const auto vec = [](const glm::vec3& v) { return kernels::Vec3<float>(v.x, v.y, v.z); };
  if (m.specular > 0) light += m.specular * kernels::highlight(m.shininess, vec(normal), vec(to_light), vec(view));
  return light;
}

}  // namespace rayengine
