#include "gpu/cones/cones_scene.h"

#include <algorithm>
#include <tuple>

#include "accel/ray_cone.h"
#include "accel/rounding.h"

namespace rayengine {
namespace {

/// What rounding in single precision can move a ray, within the frame, off its exact place: origins lie within 8, which
/// rounds by 2^-22 on each axis, and directions are rounded by 2^-24 on each, over no more than 16 lengths.
constexpr double ray_slack = 0x1p-18;

struct Entry {
  bool unbounded;
  std::uint32_t type;
  std::uint32_t rank, id;
};

std::vector<Entry> entries_of(const FlatScene& scene) {
  std::vector<Entry> entries;
  for (const TreeletPrimitive& p : treelet_primitives(*scene.geometry)) {
    const auto& ranks = p.type == TreeletPrimitive::triangle ? scene.triangle_ranks : scene.quadric_ranks;
    entries.push_back({!p.bounded(), p.type, ranks[p.id], p.id});
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::tuple(a.unbounded, a.type + 1, b.rank) < std::tuple(b.unbounded, b.type + 1, a.rank);
  });
  return entries;
}

Treelets list_of(const FlatScene& scene, const std::vector<Entry>& entries) {
  Treelets list;
  list.frame = LocalFrame(frame_bounds(*scene.geometry));
  for (const Entry& e : entries)
    (e.type == TreeletPrimitive::triangle ? list.triangles : list.quadrics).push_back(e.id);
  return list;
}

/// Runs of one type, among those that have an end or those that have none.
std::vector<ConesScene::Run> runs_of(const std::vector<Entry>& entries, const std::vector<KernelType>& types,
                                     bool unbounded) {
  std::vector<ConesScene::Run> runs;
  std::uint32_t triangles = 0, quadrics = 0;
  for (const Entry& e : entries) {
    const std::uint32_t at = e.type == TreeletPrimitive::triangle ? triangles++ : quadrics++;
    if (e.unbounded != unbounded) continue;
    const auto type = static_cast<std::size_t>(std::find(types.begin(), types.end(), e.type) - types.begin());
    if (runs.empty() || runs.back().type != type) runs.push_back({type, at, 0});
    ++runs.back().count;
  }
  return runs;
}

glm::vec4 sphere_texel(const Sphere& sphere, const LocalFrame& frame) {
  const glm::dvec3 center = (sphere.center - frame.center) * frame.scale;
  const double reach = std::max({std::abs(center.x), std::abs(center.y), std::abs(center.z)});
  const double radius = sphere.radius * frame.scale + 0x1p-23 * reach + ray_slack;
  return {glm::vec3(center), std::min(float_above(radius), 1e30f)};
}

BufferTexture spheres_of(const Geometry& g, const Treelets& list) {
  std::vector<glm::vec4> texels;
  for (const std::uint32_t i : list.triangles) {
    const glm::uvec3 t = g.triangles[i];
    texels.push_back(sphere_texel(enclosing_sphere(g.vertex(t.x), g.vertex(t.y), g.vertex(t.z)), list.frame));
  }
  for (const std::uint32_t i : list.quadrics)
    texels.push_back(sphere_texel(enclosing_sphere(g, g.quadrics[i]), list.frame));
  return make_buffer_texture(GL_RGBA32F, texels);
}

}  // namespace

ConesScene::ConesScene(std::shared_ptr<const Geometry> geometry, const GpuInfo& gpu)
    : flat(flatten(std::move(geometry))) {
  const std::vector<Entry> entries = entries_of(flat);
  list = list_of(flat, entries);
  textures = upload(flat, list, gpu);
  bounded = runs_of(entries, textures.types, false);
  unbounded = runs_of(entries, textures.types, true);
  for (Run& run : bounded)
    if (!is_triangle(run)) run.first_sphere = static_cast<std::uint32_t>(list.triangles.size());
  spheres = spheres_of(*flat.geometry, list);
}

}  // namespace rayengine
