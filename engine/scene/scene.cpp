#include "engine/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace rayengine {

namespace {

/// The smaller of a camera's two full angles, in radians.
double narrow_angle(const Camera& camera) {
  const double half = std::tan(glm::radians(camera.fov / 2)),
               aspect = static_cast<double>(camera.size.x) / camera.size.y;
  return 2 * std::atan(half * std::min(aspect, 1.0));
}

}  // namespace

Camera framing_camera(const Box& bounds, Camera camera) {
  const Box box = bounds.finite() ? bounds : Box{glm::dvec3(-1), glm::dvec3(1)};
  camera.at = box.center();
  const double radius = std::max(0.5 * glm::length(box.size()), 1e-30);
  const double distance = radius / std::sin(narrow_angle(camera) / 2) * 1.02;
  camera.from = camera.at + distance * glm::normalize(glm::dvec3(0.6, -0.8, 0.45));
  return camera;
}

Light headlight(const Camera& camera) {
  Light light;
  light.position = camera.from;
  return light;
}

}  // namespace rayengine
