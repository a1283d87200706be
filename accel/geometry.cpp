#include "accel/geometry.h"

#include <algorithm>
#include <span>
#include <utility>

#include "accel/tracer.h"

namespace rayengine {
namespace {

template <class T>
std::size_t bytes_of(const std::vector<T>& v) {
  return v.capacity() * sizeof(T);
}

/// The last element whose first_primitive is not above `primitive`, among [first, last).
template <class It>
It owner(It first, It last, std::uint32_t primitive) {
  return std::prev(std::upper_bound(first, last, primitive,
                                    [](std::uint32_t p, const auto& entry) { return p < entry.first_primitive; }));
}

/// The placement, among those that an instance object became, whose primitives include `primitive`.
const Instance& placement(const Geometry& geometry, std::uint32_t object, std::uint32_t primitive) {
  const auto first = geometry.instances.begin() + geometry.objects[object].first;
  const auto last =
      std::find_if(first, geometry.instances.end(), [=](const Instance& i) { return i.object != object; });
  const auto nested = std::next(first);  // the first places the group itself, the others what it holds
  if (nested == last || primitive < nested->first_primitive) return *first;
  const Instance& found = *owner(nested, last, primitive);
  const std::uint32_t end = found.first_primitive + geometry.groups[found.group]->primitive_count;
  return primitive < end ? found : *first;
}

}  // namespace

std::size_t Geometry::bytes() const {
  std::size_t total = bytes_of(vertices) + bytes_of(exact_vertices) + bytes_of(normals) + bytes_of(triangles) +
                      bytes_of(triangle_object) + bytes_of(quadrics) + bytes_of(forms) + bytes_of(instances) +
                      bytes_of(groups) + bytes_of(objects) + bytes_of(mesh_bounds);
  for (const auto& group : groups) total += group->bytes();
  return total;
}

std::uint32_t primitive_count(const Geometry& geometry, std::uint32_t object) {
  const bool last = object + 1 == geometry.objects.size();
  const std::uint32_t end = last ? geometry.primitive_count : geometry.objects[object + 1].first_primitive;
  return end - geometry.objects[object].first_primitive;
}

std::span<const glm::uvec3> triangles_of(const Geometry& geometry, std::uint32_t object) {
  return std::span(geometry.triangles).subspan(geometry.objects[object].first, primitive_count(geometry, object));
}

std::pair<std::uint32_t, std::uint32_t> vertex_range(std::span<const glm::uvec3> triangles) {
  std::uint32_t begin = no_id, end = 0;
  for (const glm::uvec3& t : triangles) {
    begin = std::min({begin, t.x, t.y, t.z});
    end = std::max({end, t.x + 1, t.y + 1, t.z + 1});
  }
  return {std::min(begin, end), end};
}

Mesh mesh_of(const Geometry& geometry, std::uint32_t object) {
  const auto given = triangles_of(geometry, object);
  Mesh mesh;
  mesh.triangles.assign(given.begin(), given.end());
  const auto [begin, end] = vertex_range(mesh.triangles);
  mesh.positions.reserve(end - begin);
  for (std::uint32_t v = begin; v < end; ++v) mesh.positions.push_back(geometry.vertex(v));
  if (!geometry.normals.empty()) mesh.normals.assign(geometry.normals.begin() + begin, geometry.normals.begin() + end);
  for (glm::uvec3& t : mesh.triangles) t -= begin;
  return mesh;
}

Box bounds(const Geometry& geometry, const Quadric& q) {
  return bounds(q, q.type == QuadricType::general ? &geometry.forms[q.form] : nullptr);
}

Box bounds(const Geometry& geometry, const Instance& instance) {
  const Box& box = geometry.groups[instance.group]->bounds;
  if (box.empty()) return {};
  if (!box.finite()) return {glm::dvec3(-infinity), glm::dvec3(infinity)};
  return transformed(box, object_to_world(instance.to_group));
}

PrimitiveRef resolve(const Geometry& geometry, std::uint32_t object, std::uint32_t primitive) {
  const Object& o = geometry.objects[object];
  if (o.kind != Object::Kind::instance) return {&geometry, nullptr, object, primitive};
  const Instance& instance = placement(geometry, object, primitive);
  const Geometry& group = *geometry.groups[instance.group];
  const std::uint32_t local = primitive - instance.first_primitive;
  const auto inner = owner(group.objects.begin(), group.objects.end(), local);
  return {&group, &instance, static_cast<std::uint32_t>(inner - group.objects.begin()), local - inner->first_primitive};
}

}  // namespace rayengine
