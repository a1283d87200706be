#include "engine/render/cast.h"

#include "engine/render/camera.h"

namespace rayengine {

CastView cast_view(const Camera& camera) {
  const CameraFrame frame(camera);
  const glm::dvec3 corner = frame.direction(0.5, 0.5);
  return {camera.from,   corner,       frame.direction(1.5, 0.5) - corner, frame.direction(0.5, 1.5) - corner,
          camera.size.x, camera.size.y};
}

std::vector<CastLight> cast_lights(const Scene& scene) {
  std::vector<CastLight> result;
  for (const Light& light : scene.lights) {
    const bool directional = light.type == Light::Type::directional;
    result.push_back({directional ? light.direction : light.position, directional, light.color});
  }
  return result;
}

std::vector<CastMaterial> cast_materials(const Scene& scene) {
  std::vector<CastMaterial> result;
  for (const Material& m : scene.materials)
    result.push_back({m.color, m.ambient, m.diffuse, m.specular, m.shininess, m.reflect});
  return result;
}

}  // namespace rayengine
