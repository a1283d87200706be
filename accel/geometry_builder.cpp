#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "accel/check_mesh.h"
#include "accel/geometry.h"
#include "accel/tracer.h"

namespace rayengine {
namespace {

constexpr std::size_t after_vertices = 1;  // Embree reads 16 bytes at the last one

/// For so many more: no more than that where they are the first, since most scenes hold one mesh.
template <class T>
void make_room(std::vector<T>& list, std::size_t more) {
  if (const std::size_t needed = list.size() + more; needed > list.capacity())
    list.reserve(std::max(needed, list.size() + list.size() / 2));
}

bool is_float(const glm::dvec3& p) { return glm::dvec3(glm::vec3(p)) == p; }

glm::vec3 world_normal(const WorldToObject& map, const glm::vec3& n) {
  const glm::dvec3 turned = map.normal_to_world(glm::dvec3(n));
  const double length = glm::length(turned);
  return length > 0 && std::isfinite(length) ? glm::vec3(turned / length) : glm::vec3(0);
}

std::array<double, 2> default_clip(QuadricType type) {
  switch (type) {
    case QuadricType::cylinder:
    case QuadricType::cone:
    case QuadricType::paraboloid: return {0, 1};
    case QuadricType::hyperboloid1: return {-1, 1};
    case QuadricType::hyperboloid2: return {-2, 2};
    default: return {-infinity, infinity};
  }
}

bool can_be_capped(QuadricType type) { return type >= QuadricType::cylinder && type <= QuadricType::hyperboloid2; }

/// Scales a matrix by a power of two, which moves no root, so that its largest entry lies in [1, 2).
QuadricMatrix normalised(QuadricMatrix matrix) {
  double largest = 0;
  for (double a : matrix) {
    if (!std::isfinite(a)) throw Error("a quadric's matrix is not finite");
    largest = std::max(largest, std::abs(a));
  }
  if (largest > 0)
    for (double& a : matrix) a = std::ldexp(a, -std::ilogb(largest));
  return matrix;
}

void check(const QuadricShape& shape, const std::array<double, 2>& clip) {
  const std::string name(to_string(shape.type));
  if (shape.capped && !can_be_capped(shape.type)) throw Error("a " + name + " cannot be capped");
  if (!(clip[0] < clip[1]) && shape.type != QuadricType::plane && shape.type != QuadricType::disk)
    throw Error("the clip of a " + name + " is empty: its first number must be the smaller");
  if (shape.capped && !(std::isfinite(clip[0]) && std::isfinite(clip[1])))
    throw Error("the clip of a capped " + name + " must be finite");
  if (shape.type == QuadricType::general && !shape.matrix) throw Error("a quadric needs the ten numbers of its matrix");
  if (shape.type != QuadricType::general && shape.matrix) throw Error("only a quadric takes a matrix, not a " + name);
  if (shape.box && shape.type == QuadricType::disk) throw Error("a disk takes no box: its edge is its own");
  if (shape.box && (shape.box->empty() || shape.capped))
    throw Error("the box of a " + name + " is empty, or closed by caps");
}

}  // namespace

std::uint32_t GeometryBuilder::begin(Object::Kind kind, std::size_t first, std::uint32_t material) {
  geometry_.objects.push_back({kind, static_cast<std::uint32_t>(first), geometry_.primitive_count, material});
  return static_cast<std::uint32_t>(geometry_.objects.size() - 1);
}

std::uint32_t GeometryBuilder::add(const Mesh& mesh, std::uint32_t material, const Affine& to_world) {
  check_mesh(mesh);
  const WorldToObject to_object = inverse(to_world);
  const auto base = static_cast<std::uint32_t>(geometry_.vertices.size());
  const std::uint32_t object = begin(Object::Kind::mesh, geometry_.triangles.size(), material);
  geometry_.mesh_bounds.emplace_back();
  make_room(geometry_.vertices, mesh.positions.size() + after_vertices);
  for (const glm::dvec3& p : mesh.positions) place(to_world.point(p));
  geometry_.bounds.add(geometry_.mesh_bounds.back());
  if (!mesh.normals.empty()) {
    geometry_.normals.resize(base);
    for (const glm::vec3& n : mesh.normals) geometry_.normals.push_back(world_normal(to_object, n));
  }
  place(mesh.triangles, base, object);
  geometry_.primitive_count += static_cast<std::uint32_t>(mesh.triangles.size());
  return object;
}

std::uint32_t GeometryBuilder::add(const QuadricShape& shape, std::uint32_t material, const Affine& to_world) {
  const std::array<double, 2> clip = shape.clip.value_or(default_clip(shape.type));
  check(shape, clip);
  Quadric q{inverse(to_world), clip[0], clip[1], no_id, no_id, shape.type, shape.capped};
  if (shape.type == QuadricType::general || shape.box) {
    // A box turns any type into the general form of the same surface.
    GeneralForm form{normalised(shape.matrix.value_or(unit_matrix(shape.type))),
                     shape.box.value_or(Box{glm::dvec3(-infinity), glm::dvec3(infinity)})};
    form.box.lower.z = std::max(form.box.lower.z, clip[0]);
    form.box.upper.z = std::min(form.box.upper.z, clip[1]);
    q.type = QuadricType::general;
    q.form = static_cast<std::uint32_t>(geometry_.forms.size());
    geometry_.forms.push_back(form);
  }
  q.object = begin(Object::Kind::quadric, geometry_.quadrics.size(), material);
  place(q);
  geometry_.primitive_count += primitive_count(q);
  return q.object;
}

std::uint32_t GeometryBuilder::group_index(const std::shared_ptr<const Geometry>& group) {
  for (std::size_t i = geometry_.groups.size(); i-- > 0;)  // mostly the same group again
    if (geometry_.groups[i] == group) return static_cast<std::uint32_t>(i);
  geometry_.groups.push_back(group);
  return static_cast<std::uint32_t>(geometry_.groups.size() - 1);
}

void GeometryBuilder::place(const glm::dvec3& vertex) {
  if (single_ && !is_float(vertex)) {
    single_ = false;
    geometry_.exact_vertices.assign(geometry_.vertices.begin(), geometry_.vertices.end());
  }
  geometry_.vertices.emplace_back(vertex);
  if (!single_) geometry_.exact_vertices.push_back(vertex);
  geometry_.mesh_bounds.back().add(vertex);
}

void GeometryBuilder::place(std::span<const glm::uvec3> triangles, std::uint32_t base, std::uint32_t object) {
  make_room(geometry_.triangles, triangles.size());
  make_room(geometry_.triangle_object, triangles.size());
  for (const glm::uvec3& t : triangles) geometry_.triangles.push_back(t + base);
  geometry_.triangle_object.resize(geometry_.triangles.size(), object);
}

void GeometryBuilder::place(const Quadric& quadric) {
  const Box box = bounds(geometry_, quadric);
  geometry_.quadric_bounds.add(box);
  geometry_.bounds.add(box);
  geometry_.quadrics.push_back(quadric);
}

void GeometryBuilder::place(const Instance& instance) {
  geometry_.bounds.add(bounds(geometry_, instance));
  geometry_.instances.push_back(instance);
}

std::uint32_t GeometryBuilder::add(std::shared_ptr<const Geometry> group, const Affine& to_world,
                                   std::uint32_t material) {
  const WorldToObject to_group = inverse(to_world);
  const std::uint32_t object = begin(Object::Kind::instance, geometry_.instances.size(), material);
  place(Instance{to_group, group_index(group), object, 0});
  for (const Instance& inner : group->instances) {
    const Affine nested = to_world * object_to_world(inner.to_group);
    place(Instance{inverse(nested), group_index(group->groups[inner.group]), object,
                   group->objects[inner.object].first_primitive + inner.first_primitive});
  }
  geometry_.primitive_count += group->primitive_count;
  return object;
}

std::uint32_t GeometryBuilder::add(const Geometry& from, std::uint32_t object) {
  const Object& o = from.objects[object];
  const std::size_t first = o.kind == Object::Kind::mesh      ? geometry_.triangles.size()
                            : o.kind == Object::Kind::quadric ? geometry_.quadrics.size()
                                                              : geometry_.instances.size();
  const std::uint32_t copy = begin(o.kind, first, o.material);
  if (o.kind == Object::Kind::mesh) copy_mesh(mesh_of(from, object), copy);
  if (o.kind == Object::Kind::quadric) copy_quadric(from, o, copy);
  if (o.kind == Object::Kind::instance) copy_instances(from, object, copy);
  geometry_.primitive_count += rayengine::primitive_count(from, object);
  return copy;
}

void GeometryBuilder::copy_mesh(const Mesh& mesh, std::uint32_t copy) {
  const auto base = static_cast<std::uint32_t>(geometry_.vertices.size());
  geometry_.mesh_bounds.emplace_back();
  make_room(geometry_.vertices, mesh.positions.size() + after_vertices);
  for (const glm::dvec3& p : mesh.positions) place(p);
  geometry_.bounds.add(geometry_.mesh_bounds.back());
  if (!mesh.normals.empty()) {
    geometry_.normals.resize(base);
    geometry_.normals.insert(geometry_.normals.end(), mesh.normals.begin(), mesh.normals.end());
  }
  place(mesh.triangles, base, copy);
}

void GeometryBuilder::copy_quadric(const Geometry& from, const Object& object, std::uint32_t copy) {
  Quadric q = from.quadrics[object.first];
  q.object = copy;
  if (q.type == QuadricType::general) {
    geometry_.forms.push_back(from.forms[q.form]);
    q.form = static_cast<std::uint32_t>(geometry_.forms.size() - 1);
  }
  place(q);
}

void GeometryBuilder::copy_instances(const Geometry& from, std::uint32_t object, std::uint32_t copy) {
  for (std::size_t i = from.objects[object].first; i < from.instances.size() && from.instances[i].object == object;
       ++i) {
    Instance instance = from.instances[i];
    instance.group = group_index(from.groups[instance.group]);
    instance.object = copy;
    place(instance);
  }
}

std::shared_ptr<const Geometry> GeometryBuilder::build() {
  if (!geometry_.normals.empty()) geometry_.normals.resize(geometry_.vertices.size());
  geometry_.vertices.reserve(geometry_.vertices.size() + after_vertices);
  auto result = std::make_shared<const Geometry>(std::move(geometry_));
  *this = {};
  return result;
}

}  // namespace rayengine
