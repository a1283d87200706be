#include "gpu/scene/shading_textures.h"

#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "accel/tracer.h"
#include "gpu/scene/flat_scene.h"

namespace rayengine {
namespace {

enum : GLuint { owners_unit = 12, materials_unit = 13, lights_unit = 14 };

/// Of each primitive, by rank, its material.
BufferTexture upload_owners(const Geometry& geometry, std::size_t material_count) {
  std::vector<std::uint32_t> owners;
  for (std::uint32_t rank = 0; rank < geometry.primitive_count; ++rank) {
    const Ids ids = ids_of_rank(geometry, rank);
    const PrimitiveRef ref = resolve(geometry, ids.object, ids.primitive);
    owners.push_back(ref.geometry->objects[ref.object].material);
    if (owners.back() >= material_count)
      throw Error("object " + std::to_string(ids.object) + " has material " + std::to_string(owners.back()) +
                  ", and there are " + std::to_string(material_count));
  }
  return make_buffer_texture(GL_R32UI, owners);
}

BufferTexture upload_materials(std::span<const CastMaterial> materials) {
  std::vector<glm::vec4> texels;
  for (const CastMaterial& m : materials) {
    texels.emplace_back(m.color, m.ambient);
    texels.emplace_back(m.diffuse, m.specular, m.shininess, m.reflect);
  }
  return make_buffer_texture(GL_RGBA32F, texels);
}

BufferTexture upload_lights(std::span<const CastLight> lights, const LocalFrame& frame) {
  std::vector<glm::vec4> texels;
  for (const CastLight& l : lights) {
    const glm::dvec3 place = l.directional ? -glm::normalize(l.position) : (l.position - frame.center) * frame.scale;
    texels.emplace_back(glm::vec3(place), l.directional ? 0 : 1);
    texels.emplace_back(l.color, 0);
  }
  return make_buffer_texture(GL_RGBA32F, texels);
}

}  // namespace

ShadingTextures::ShadingTextures(const Geometry& geometry, const LocalFrame& frame, std::span<const CastLight> lights,
                                 std::span<const CastMaterial> materials)
    : owners_(upload_owners(geometry, materials.size())),
      materials_(upload_materials(materials)),
      lights_(upload_lights(lights, frame)) {}

void ShadingTextures::bind() const {
  owners_.bind(owners_unit);
  materials_.bind(materials_unit);
  lights_.bind(lights_unit);
}

}  // namespace rayengine
