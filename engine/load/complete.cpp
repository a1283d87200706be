#include "engine/load/complete.h"

#include <glm/geometric.hpp>

#include "accel/tracer.h"

namespace rayengine {
namespace {

void add_if_finite(Box& sum, const Box& box) {
  if (box.finite()) sum.add(box);
}

}  // namespace

Box finite_bounds(const Geometry& geometry) {
  Box box;
  for (std::uint32_t i = 0; i < geometry.vertices.size(); ++i) box.add(geometry.vertex(i));
  for (const Quadric& q : geometry.quadrics) add_if_finite(box, bounds(geometry, q));
  for (const Instance& i : geometry.instances) add_if_finite(box, bounds(geometry, i));
  return box;
}

void complete(Scene& scene, bool has_camera) {
  if (!has_camera) {
    scene.camera = framing_camera(scene.geometry ? finite_bounds(*scene.geometry) : Box{}, scene.camera);
    scene.notes.push_back("the scene has no camera; one that frames it was put in");
  }
  if (scene.lights.empty()) {
    scene.lights.push_back(headlight(scene.camera));
    scene.notes.push_back("the scene has no light; a headlight at the eye was put in");
  }
}

void check(const Camera& camera) {
  const glm::dvec3 view = camera.at - camera.from;
  if (!(glm::length(view) > 0)) throw Error("the camera stands where it looks; 'from' and 'at' must differ");
  const glm::dvec3 right = glm::cross(view, camera.up);
  if (!(glm::length(right) > 1e-12 * glm::length(view) * glm::length(camera.up)))
    throw Error("the camera's up is zero or along its view; turn it away");
  if (!(camera.fov > 0 && camera.fov < 180))
    throw Error("the camera's angle is out of range; it must lie between 0 and 180 degrees");
  for (const int side : {camera.size.x, camera.size.y})
    if (side < 1 || side > 65536) throw Error("the picture's size is out of range; each side takes 1 to 65536 pixels");
}

}  // namespace rayengine
