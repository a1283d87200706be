#include "engine/load/json_objects.h"

#include "engine/load/json_transform.h"
#include "engine/load/load.h"
#include "engine/load/text.h"

namespace rayengine {
namespace {

constexpr int deepest_group = 64;

// Groups within groups multiply: a few lines can ask for more than any memory holds.
constexpr std::uint64_t most_nested = 1u << 22, most_primitives = no_id - 1;

Box box(const JsonView& value) {
  const std::vector<JsonView> corners = value.list_of(2, "corners");
  return {corners[0].vector(), corners[1].vector()};
}

Affine transform(JsonFields& fields) {
  const auto value = fields.find("transform");
  return value ? read_transform(*value) : Affine{};
}

std::string object_types() {
  std::string names;
  for (std::size_t i = 0; i < quadric_type_count; ++i)
    names += std::string(to_string(static_cast<QuadricType>(i))) + ", ";
  return names + "mesh, triangles or instance";
}

Mesh read_triangles(JsonFields& fields) {
  Mesh mesh;
  for (const JsonView& vertex : fields.need("vertices").list()) mesh.positions.push_back(vertex.vector());
  const JsonView indices = fields.need("indices");
  const int last = static_cast<int>(mesh.positions.size()) - 1;
  for (const JsonView& corners : indices.list()) {
    const std::vector<JsonView> corner = corners.list_of(3, "vertices");
    mesh.triangles.emplace_back(corner[0].integer(0, last), corner[1].integer(0, last), corner[2].integer(0, last));
  }
  if (mesh.triangles.empty()) fail(indices.place(), "there is no triangle in 'indices'; give it one");
  return mesh;
}

}  // namespace

JsonObjects::JsonObjects(std::filesystem::path folder, const MaterialIndices& materials,
                         const std::optional<JsonView>& groups, std::vector<std::string>& notes)
    : folder_(std::move(folder)), materials_(materials), notes_(notes) {
  if (!groups) return;
  for (const JsonView& member : groups->members()) groups_.emplace(member.name(), Group{member, nullptr});
}

std::shared_ptr<const Geometry> JsonObjects::build(const JsonView& list) {
  const std::vector<JsonView> objects = list.list();
  if (objects.empty()) fail(list.place(), "there is nothing in " + quoted(list.name()) + "; give it an object");
  check_size(objects);
  GeometryBuilder builder;
  for (const JsonView& object : objects) add(builder, object);
  return builder.build();
}

void JsonObjects::check_size(const std::vector<JsonView>& objects) {
  std::uint64_t instances = 0, primitives = 0;
  for (const JsonView& object : objects) {
    JsonFields fields(object);
    if (fields.need("type").string() != "instance") continue;
    const std::shared_ptr<const Geometry> placed = group(fields.need("group"));
    instances += placed->instances.size();
    primitives += placed->primitive_count;
    if (instances > most_nested || primitives > most_primitives)
      fail(object.place(), "groups multiply to more than 2^22 instances or 2^32 primitives; place fewer");
  }
}

void JsonObjects::build_groups() {
  for (auto& [name, group] : groups_) build(group);
}

void JsonObjects::add(GeometryBuilder& builder, const JsonView& object) {
  JsonFields fields(object);
  const JsonView type = fields.need("type");
  const std::string_view name = type.string();
  if (name == "instance") return add_instance(builder, fields);
  if (name == "mesh") return add_mesh(builder, fields, read_mesh(fields));
  if (name == "triangles") return add_mesh(builder, fields, read_triangles(fields));
  if (const auto quadric = parse_quadric_type(name)) return add_quadric(builder, fields, *quadric);
  fail(type.place(), "unknown type of object " + quoted(name) + "; use " + object_types());
}

void JsonObjects::add_quadric(GeometryBuilder& builder, JsonFields& fields, QuadricType type) const {
  QuadricShape shape;
  shape.type = type;
  fields.read("capped", shape.capped, &JsonView::boolean);
  if (type == QuadricType::general) fields.read("Q", shape.matrix, &JsonView::numbers<10>);
  // Clipping says nothing of a plane at z = 0, and a disk has its own edge.
  if (type != QuadricType::plane && type != QuadricType::disk) fields.read("clip", shape.clip, &JsonView::numbers<2>);
  if (type != QuadricType::disk) fields.read("box", shape.box, box);
  const std::uint32_t of = material(fields);
  const Affine to_world = transform(fields);
  fields.finish();
  at_place(fields.place(), [&] { builder.add(shape, of, to_world); });
}

void JsonObjects::add_mesh(GeometryBuilder& builder, JsonFields& fields, const Mesh& mesh) const {
  const std::uint32_t of = material(fields);
  const Affine to_world = transform(fields);
  fields.finish();
  at_place(fields.place(), [&] { builder.add(mesh, of, to_world); });
}

void JsonObjects::add_instance(GeometryBuilder& builder, JsonFields& fields) {
  const std::shared_ptr<const Geometry> placed = group(fields.need("group"));
  const Affine to_world = transform(fields);
  fields.finish();
  at_place(fields.place(), [&] { builder.add(placed, to_world); });
}

std::uint32_t JsonObjects::material(JsonFields& fields) const {
  const auto value = fields.find("material");
  if (!value) return 0;
  const std::string_view name = value->string();
  const auto found = materials_.find(name);
  if (found == materials_.end()) fail(value->place(), "there is no material " + quoted(name));
  return found->second;
}

const Mesh& JsonObjects::read_mesh(JsonFields& fields) {
  const JsonView file = fields.need("file");
  const std::filesystem::path path = folder_ / file.string();
  const auto known = meshes_.find(path);
  if (known != meshes_.end()) return known->second;
  return meshes_.emplace(path, at_place(file.place(), [&] { return load_mesh(path, notes_); })).first->second;
}

std::shared_ptr<const Geometry> JsonObjects::group(const JsonView& value) {
  const std::string_view name = value.string();
  const auto found = groups_.find(name);
  if (found == groups_.end()) fail(value.place(), "there is no group " + quoted(name));
  if (found->second.is_open) fail(value.place(), "group " + quoted(name) + " holds itself");
  if (depth_ == deepest_group) fail(value.place(), "groups hold each other more than 64 deep");
  build(found->second);
  return found->second.geometry;
}

void JsonObjects::build(Group& group) {
  if (group.geometry) return;
  JsonFields fields(group.value);
  const JsonView objects = fields.need("objects");
  fields.finish();
  group.is_open = true;
  ++depth_;
  group.geometry = build(objects);
  --depth_;
  group.is_open = false;
}

}  // namespace rayengine
