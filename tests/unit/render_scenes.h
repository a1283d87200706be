#pragma once

#include "engine/render/render.h"
#include "engine/tracers.h"

namespace rayengine::test {

/// A camera of one pixel, whose only ray runs from `from` to `at`.
inline Camera one_ray(const glm::dvec3& from, const glm::dvec3& at) {
  const glm::dvec3 up = at.x == from.x && at.y == from.y ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  return {.from = from, .at = at, .up = up, .fov = 45, .size = {1, 1}};
}

inline Light point_light(const glm::dvec3& position, const glm::vec3& color = glm::vec3(1)) {
  return {.type = Light::Type::point, .position = position, .color = color};
}

inline Scene scene_of(GeometryBuilder& builder, const Material& material, const Camera& camera) {
  Scene scene;
  scene.camera = camera;
  scene.materials = {material};
  scene.geometry = builder.build();
  return scene;
}

inline RenderResult render_with(std::string_view tracer, const Scene& scene, const RenderOptions& options = {}) {
  return render(scene, *make_tracer(tracer, scene.geometry), options);
}

/// What the ray of a one-pixel camera sees.
inline glm::vec3 seen(const Scene& scene, const RenderOptions& options = {}) {
  const RenderResult result = render_with("embree", scene, options);
  const float* p = result.image.pixel(0, 0);
  return {p[0], p[1], p[2]};
}

inline constexpr QuadricShape unit_sphere{.type = QuadricType::sphere};
inline constexpr QuadricShape ground{.type = QuadricType::plane};

/// A closed mesh around the unit sphere: `rings` bands of latitude, counter-clockwise seen from outside.
Mesh globe(int rings);

}  // namespace rayengine::test
