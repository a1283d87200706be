#include "engine/scene/scene.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace rayengine {

Camera framing_camera(const Box& bounds) {
  const Box box = bounds.finite() ? bounds : Box{glm::dvec3(-1), glm::dvec3(1)};
  Camera camera;
  camera.at = box.center();
  const double radius = std::max(0.5 * glm::length(box.size()), 1e-30);
  const double distance = radius / std::sin(glm::radians(camera.fov / 2)) * 1.02;
  camera.from = camera.at + distance * glm::normalize(glm::dvec3(0.6, -0.8, 0.45));
  return camera;
}

Light headlight(const Camera& camera) {
  Light light;
  light.position = camera.from;
  return light;
}

}  // namespace rayengine
