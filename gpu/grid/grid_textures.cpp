#include "gpu/grid/grid_textures.h"

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>
#include <string>

#include "accel/tracer.h"
#include "gpu/scene/kernel_program.h"

namespace rayengine {
namespace {

enum : GLuint { voxels_unit = 9, triangle_members_unit = 10, quadric_members_unit = 11 };
enum : GLint { lower_location = 5, cell_location = 6, counts_location = 7 };

BufferTexture upload_numbers(const std::vector<std::uint32_t>& numbers, const char* what, const GpuInfo& gpu) {
  require_texels(numbers.size(), what, gpu);
  return make_buffer_texture(GL_R32UI, numbers);
}

void require_short_lists(const Treelets& lists) {
  std::uint32_t longest = 0;
  for (const Treelet& list : lists.treelets) longest = std::max({longest, list.triangle_count, list.quadric_count});
  longest = std::max({longest, lists.unbounded.triangle_count, lists.unbounded.quadric_count});
  if (longest > longest_loop)
    throw Error("a voxel of the grid lists " + std::to_string(longest) + " primitives, more than " +
                std::to_string(longest_loop) + ", what a shader can test in one loop; use --tracer stream");
}

SceneTextures upload_scene(const FlatScene& scene, const Grid& grid, const GpuInfo& gpu) {
  require_short_lists(grid.lists);
  SceneTextures textures = upload(scene, grid.lists.frame, gpu);
  textures.ranges = upload_ranges(*scene.geometry, grid.lists, textures.types, gpu);
  textures.bytes += textures.ranges.buffer.bytes;
  return textures;
}

}  // namespace

GridTextures::GridTextures(const FlatScene& scene, const Grid& grid, const GpuInfo& gpu)
    : scene_(upload_scene(scene, grid, gpu)),
      voxels_(upload_numbers(grid.voxels, "voxels", gpu)),
      triangle_members_(upload_numbers(grid.lists.triangles, "lists of triangles", gpu)),
      quadric_members_(upload_numbers(grid.lists.quadrics, "lists of quadrics", gpu)),
      lower_(grid.lower),
      cell_(grid.cell),
      counts_(grid.counts) {}

void GridTextures::bind() const {
  scene_.bind();
  scene_.ranges.bind(ranges_unit);
  voxels_.bind(voxels_unit);
  triangle_members_.bind(triangle_members_unit);
  quadric_members_.bind(quadric_members_unit);
}

void GridTextures::set_uniforms() const {
  glUniform1i(types_location, static_cast<GLint>(types().size()));
  glUniform3fv(lower_location, 1, glm::value_ptr(lower_));
  glUniform3fv(cell_location, 1, glm::value_ptr(cell_));
  glUniform3fv(counts_location, 1, glm::value_ptr(counts_));
}

std::size_t GridTextures::bytes() const {
  return scene_.bytes + voxels_.buffer.bytes + triangle_members_.buffer.bytes + quadric_members_.buffer.bytes;
}

}  // namespace rayengine
