#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "accel/box.h"
#include "accel/quadric.h"
#include "accel/transform.h"

namespace rayengine {

/// A triangle mesh as callers and loaders give it. Counter-clockwise triangles face the front.
struct Mesh {
  std::vector<glm::dvec3> positions;
  std::vector<glm::vec3> normals;  ///< one per position, or none; a zero normal means the flat one
  std::vector<glm::uvec3> triangles;
};

struct Object {
  enum class Kind : std::uint8_t { mesh, quadric, instance };
  Kind kind = Kind::mesh;
  std::uint32_t first = 0;            ///< its first triangle, its quadric, or its first instance
  std::uint32_t first_primitive = 0;  ///< primitives of all objects before it, which number an instance's primitives
  std::uint32_t material = 0;         ///< the caller's; of no meaning here
};

/// One placement of a group. An instance object of a group that holds instances itself becomes several of these.
struct Instance {
  WorldToObject to_group;
  std::uint32_t group = 0;
  std::uint32_t object = 0;           ///< the object it is part of
  std::uint32_t first_primitive = 0;  ///< the primitive id, within the object, of the group's first primitive
};
static_assert(sizeof(Instance) <= 112);

/// Everything that rays can hit; immutable once built (see GeometryBuilder). Where a group holds instances, whoever
/// places it places those too, so that only the top level's `instances` count.
struct Geometry {
  std::vector<glm::vec3> vertices;         ///< what single precision sees
  std::vector<glm::dvec3> exact_vertices;  ///< the vertices in double; empty when `vertices` are exact
  std::vector<glm::vec3> normals;          ///< one per vertex, or none at all; zero where the mesh has none
  std::vector<glm::uvec3> triangles;
  std::vector<std::uint32_t> triangle_object;

  std::vector<Quadric> quadrics;
  std::vector<GeneralForm> forms;

  std::vector<Instance> instances;
  std::vector<std::shared_ptr<const Geometry>> groups;

  std::vector<Object> objects;
  std::vector<Box> mesh_bounds;       ///< of each mesh object, in their order
  Box quadric_bounds;                 ///< of all quadrics
  Box bounds;                         ///< of everything, instances included
  std::uint32_t primitive_count = 0;  ///< of everything, instances included

  glm::dvec3 vertex(std::uint32_t i) const {
    return exact_vertices.empty() ? glm::dvec3(vertices[i]) : exact_vertices[i];
  }
  /// Bytes held by the arrays above, groups included once each.
  std::size_t bytes() const;
};

/// A mesh object as it was given, in world space.
Mesh mesh_of(const Geometry& geometry, std::uint32_t object);

/// Those of a mesh object.
std::span<const glm::uvec3> triangles_of(const Geometry& geometry, std::uint32_t object);

/// First vertex of some triangles and last but one: meshes have theirs in a row.
std::pair<std::uint32_t, std::uint32_t> vertex_range(std::span<const glm::uvec3> triangles);

/// How many primitive ids an object takes: its triangles, a quadric's parts, or all that an instance places.
std::uint32_t primitive_count(const Geometry& geometry, std::uint32_t object);

Box bounds(const Geometry& geometry, const Quadric& quadric);
Box bounds(const Geometry& geometry, const Instance& instance);

/// The primitive of a group (or of the geometry itself) that a hit's ids name.
struct PrimitiveRef {
  const Geometry* geometry = nullptr;  ///< the one that holds the primitive
  const Instance* instance = nullptr;  ///< null when it is not instanced
  std::uint32_t object = 0;            ///< the object within `geometry`
  std::uint32_t primitive = 0;         ///< the primitive within that object
  /// Its triangle in `geometry`; only for meshes.
  std::uint32_t triangle() const { return geometry->objects[object].first + primitive; }
  const Quadric& quadric() const { return geometry->quadrics[geometry->objects[object].first]; }
  bool is_triangle() const { return geometry->objects[object].kind == Object::Kind::mesh; }
};

/// Resolves a hit's object and primitive ids, through instances.
PrimitiveRef resolve(const Geometry& geometry, std::uint32_t object, std::uint32_t primitive);

/// Collects objects in order and makes a Geometry of them. Every add returns the new object's id, and throws Error,
/// with the builder left as it was, on numbers that are not finite, indices out of range and singular transforms.
class GeometryBuilder {
 public:
  /// `to_world` is applied to positions and, as normals need it, to normals.
  std::uint32_t add(const Mesh& mesh, std::uint32_t material = 0, const Affine& to_world = {});
  std::uint32_t add(const QuadricShape& shape, std::uint32_t material = 0, const Affine& to_world = {});
  /// Places a group without copying it. Groups that hold instances are flattened to instances of what they hold.
  std::uint32_t add(std::shared_ptr<const Geometry> group, const Affine& to_world = {}, std::uint32_t material = 0);

  /// Copies an object of another geometry bit for bit, with its material; groups are shared.
  std::uint32_t add(const Geometry& from, std::uint32_t object);

  std::size_t object_count() const { return geometry_.objects.size(); }
  /// Ends the building; the builder is empty afterwards.
  std::shared_ptr<const Geometry> build();

 private:
  std::uint32_t begin(Object::Kind kind, std::size_t first, std::uint32_t material);
  void copy_mesh(const Mesh& mesh, std::uint32_t copy);
  void copy_quadric(const Geometry& from, const Object& object, std::uint32_t copy);
  void copy_instances(const Geometry& from, std::uint32_t object, std::uint32_t copy);
  void place(const glm::dvec3& vertex);
  void place(std::span<const glm::uvec3> triangles, std::uint32_t base, std::uint32_t object);
  void place(const Quadric& quadric);
  void place(const Instance& instance);
  std::uint32_t group_index(const std::shared_ptr<const Geometry>& group);

  Geometry geometry_;
  bool single_ = true;  // whether single precision holds all vertices
};

}  // namespace rayengine
