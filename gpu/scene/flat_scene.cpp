#include "gpu/scene/flat_scene.h"

#include <algorithm>
#include <string>

#include "accel/tracer.h"

namespace rayengine {
namespace {

std::uint32_t triangle_rank(const Geometry& g, std::uint32_t triangle) {
  const Object& object = g.objects[g.triangle_object[triangle]];
  return object.first_primitive + (triangle - object.first);
}

std::uint32_t quadric_rank(const Geometry& g, const Quadric& quadric) {
  return g.objects[quadric.object].first_primitive;
}

void rank_own(const Geometry& g, FlatScene& scene) {
  for (std::uint32_t i = 0; i < g.triangles.size(); ++i) scene.triangle_ranks.push_back(triangle_rank(g, i));
  for (const Quadric& q : g.quadrics) scene.quadric_ranks.push_back(quadric_rank(g, q));
}

std::vector<glm::dvec3> exact_vertices(const Geometry& g) {
  if (!g.exact_vertices.empty()) return g.exact_vertices;
  return {g.vertices.begin(), g.vertices.end()};
}

void add_vertices(Geometry& to, const Geometry& group, const Affine& to_world) {
  for (std::uint32_t i = 0; i < group.vertices.size(); ++i) {
    to.exact_vertices.push_back(to_world.point(group.vertex(i)));
    to.vertices.emplace_back(to.exact_vertices.back());
  }
}

void add_quadric(Geometry& to, const Geometry& group, Quadric q, const Affine& to_world) {
  q.to_object = inverse(to_world * object_to_world(q.to_object));
  if (q.form != no_id) {
    to.forms.push_back(group.forms[q.form]);
    q.form = static_cast<std::uint32_t>(to.forms.size() - 1);
  }
  to.quadrics.push_back(q);
}

void place(FlatScene& scene, Geometry& to, const Geometry& group, const Instance& instance, std::uint32_t first_rank) {
  const Affine to_world = object_to_world(instance.to_group);
  const auto base = static_cast<std::uint32_t>(to.vertices.size());
  add_vertices(to, group, to_world);
  for (std::uint32_t i = 0; i < group.triangles.size(); ++i) {
    to.triangles.push_back(group.triangles[i] + base);
    to.triangle_object.push_back(instance.object);
    scene.triangle_ranks.push_back(first_rank + triangle_rank(group, i));
  }
  for (const Quadric& q : group.quadrics) {
    add_quadric(to, group, q, to_world);
    scene.quadric_ranks.push_back(first_rank + quadric_rank(group, q));
  }
}

}  // namespace

FlatScene flatten(std::shared_ptr<const Geometry> geometry, std::size_t limit) {
  FlatScene scene;
  rank_own(*geometry, scene);
  if (geometry->instances.empty()) {
    scene.geometry = std::move(geometry);
    return scene;
  }
  if (geometry->primitive_count > limit)
    throw Error("the scene's instances place " + std::to_string(geometry->primitive_count) +
                " primitives, more than the GPU tracers copy (" + std::to_string(limit) + "); use --tracer embree");
  auto flat = std::make_shared<Geometry>();
  flat->vertices = geometry->vertices;
  flat->exact_vertices = exact_vertices(*geometry);
  flat->triangles = geometry->triangles;
  flat->triangle_object = geometry->triangle_object;
  flat->quadrics = geometry->quadrics;
  flat->forms = geometry->forms;
  for (const Instance& i : geometry->instances)
    place(scene, *flat, *geometry->groups[i.group], i, geometry->objects[i.object].first_primitive + i.first_primitive);
  scene.geometry = std::move(flat);
  return scene;
}

Ids ids_of_rank(const Geometry& geometry, std::uint32_t rank) {
  const auto above = std::upper_bound(geometry.objects.begin(), geometry.objects.end(), rank,
                                      [](std::uint32_t r, const Object& o) { return r < o.first_primitive; });
  const auto object = static_cast<std::uint32_t>(above - geometry.objects.begin() - 1);
  return {object, rank - geometry.objects[object].first_primitive};
}

}  // namespace rayengine
