#include "accel/geometry.h"

#include <algorithm>

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

Box transformed(const Box& box, const Affine& map) {
  Box result;
  for (int corner = 0; corner < 8; ++corner)
    result.add(map.point({corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                          corner & 4 ? box.upper.z : box.lower.z}));
  return result;
}

}  // namespace

std::size_t Geometry::bytes() const {
  std::size_t total = bytes_of(vertices) + bytes_of(exact_vertices) + bytes_of(normals) + bytes_of(triangles) +
                      bytes_of(triangle_object) + bytes_of(quadrics) + bytes_of(forms) + bytes_of(instances) +
                      bytes_of(groups) + bytes_of(objects);
  for (const auto& group : groups) total += group->bytes();
  return total;
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
