#include "engine/render/camera.h"

#include <glm/trigonometric.hpp>

#include "accel/tracer.h"
#include "engine/render/render.h"

namespace rayengine {
namespace {

/// `up` must leave the view by more than this sine, or rounding would choose how the picture is turned.
constexpr double smallest_sine = 1e-10;

void check(bool good, const char* what) {
  if (!good) throw Error(std::string("the camera sees nothing: ") + what);
}

}  // namespace

CameraFrame::CameraFrame(const Camera& camera) : from_(camera.from), middle_(0.5 * glm::dvec2(camera.size)) {
  // Written so that NaN and infinity fail as well.
  const double distance = glm::length(camera.at - camera.from);
  check(distance > 0 && distance < infinity, "`from` and `at` must be two finite points");
  center_ = (camera.at - camera.from) / distance;
  const glm::dvec3 across = glm::cross(center_, camera.up);
  const double sine = glm::length(across) / glm::length(camera.up);
  check(sine > smallest_sine && sine < infinity, "`up` must not be zero or along the view; choose another axis");
  check(camera.fov > 0 && camera.fov < 180, "`fov` must lie between 0 and 180 degrees");
  check(camera.size.x > 0 && camera.size.y > 0, "its image needs at least one pixel");
  const double pixel = 2 * std::tan(0.5 * glm::radians(camera.fov)) / camera.size.y;
  right_ = glm::normalize(across);
  up_ = pixel * glm::cross(right_, center_);
  right_ *= pixel;
}

Ray camera_ray(const Camera& camera, double x, double y) {
  Ray ray;
  CameraFrame(camera).start(ray, x, y);
  return ray;
}

}  // namespace rayengine
