#include "gpu/shade_pass.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "accel/tracer.h"
#include "gpu/flat_scene.h"

namespace rayengine {
namespace {

enum Unit : GLuint { owners_unit = 1, materials_unit = 2, lights_unit = 3 };
constexpr GLint light_count_location = 1;

Program make_program() {
  return make_screen_program("shade", {0,
                                       {"accel/kernels/prelude.glsl", "accel/kernels/highlight.glsl",
                                        "gpu/shaders/objects/packed.glsl", "gpu/shaders/objects/shade.frag.glsl"},
                                       {}});
}

template <class T>
BufferTexture texture_of(GLenum format, const std::vector<T>& content) {
  return make_buffer_texture(format, std::as_bytes(std::span(content)));
}

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
  return texture_of(GL_R32UI, owners);
}

BufferTexture upload_materials(std::span<const CastMaterial> materials) {
  std::vector<glm::vec4> texels;
  for (const CastMaterial& m : materials) {
    texels.emplace_back(m.color, m.ambient);
    texels.emplace_back(m.diffuse, m.specular, m.shininess, 0);
  }
  return texture_of(GL_RGBA32F, texels);
}

BufferTexture upload_lights(std::span<const CastLight> lights, const LocalFrame& frame) {
  std::vector<glm::vec4> texels;
  for (const CastLight& l : lights) {
    const glm::dvec3 place = l.directional ? -glm::normalize(l.position) : (l.position - frame.center) * frame.scale;
    texels.emplace_back(glm::vec3(place), l.directional ? 0 : 1);
    texels.emplace_back(l.color, 0);
  }
  return texture_of(GL_RGBA32F, texels);
}

}  // namespace

ShadePass::ShadePass(const Geometry& geometry, const LocalFrame& frame, std::span<const CastLight> lights,
                     std::span<const CastMaterial> materials, GLsizei side)
    : program_(make_program()),
      owners_(upload_owners(geometry, materials.size())),
      materials_(upload_materials(materials)),
      lights_(upload_lights(lights, frame)),
      light_count_(static_cast<GLint>(lights.size())),
      side_(side),
      color_(make_texture(GL_RGBA32F, side, side)),
      read_back_(make_mapped_buffer(static_cast<std::size_t>(side * side) * sizeof(glm::vec4), Mapping::read_back)) {
  glNamedFramebufferTexture(frame_.id(), GL_COLOR_ATTACHMENT0, color_.object.id(), 0);
}

void ShadePass::run(std::span<glm::vec4> colors, Context& context) {
  owners_.bind(owners_unit);
  materials_.bind(materials_unit);
  lights_.bind(lights_unit);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_.id());
  program_.use();
  glUniform1i(light_count_location, light_count_);
  draw_everywhere();
  glBindBuffer(GL_PIXEL_PACK_BUFFER, read_back_.object.id());
  const auto rows =
      static_cast<GLsizei>((colors.size() + static_cast<std::size_t>(side_) - 1) / static_cast<std::size_t>(side_));
  glReadPixels(0, 0, side_, rows, GL_RGBA, GL_FLOAT, nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
  await(Fence(), context);
  const auto seen = read_back_.as<const glm::vec4>(0, colors.size());
  std::copy(seen.begin(), seen.end(), colors.begin());
}

}  // namespace rayengine
