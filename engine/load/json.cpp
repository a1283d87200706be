#include "engine/load/complete.h"
#include "engine/load/image_io.h"
#include "engine/load/json_camera.h"
#include "engine/load/json_objects.h"
#include "engine/load/json_view.h"
#include "engine/load/load.h"
#include "engine/load/text.h"

// The scene file of docs/scene-format.md.
namespace rayengine {
namespace {

glm::ivec2 read_size(const JsonView& value) {
  const std::vector<JsonView> sides = value.list_of(2, "numbers");
  constexpr int largest = 65536;
  return {sides[0].integer(1, largest), sides[1].integer(1, largest)};
}

/// True when it says where the camera stands or looks; else the scene is to be framed.
bool read_camera(const JsonView& value, Camera& camera) {
  JsonFields fields(value);
  const bool posed = read_pose(fields, camera);
  fields.read("size", camera.size, read_size);
  fields.finish();
  at_place(value.place(), [&] { check(camera); });
  return posed;
}

Background read_background(const JsonView& value, const std::filesystem::path& folder) {
  if (value.is_list()) return {value.color(), nullptr};
  JsonFields fields(value);
  const JsonView image = fields.need("image");
  fields.finish();
  return at_place(image.place(), [&] {
    return Background{glm::vec3(0), std::make_shared<Image>(read_image(folder / image.string()))};
  });
}

Light::Type read_light_type(const JsonView& value) {
  const std::string_view name = value.string();
  if (name == "point") return Light::Type::point;
  if (name == "directional") return Light::Type::directional;
  fail(value.place(), "unknown type of light " + quoted(name) + "; use point or directional");
}

glm::dvec3 read_direction(const JsonView& value) {
  const glm::dvec3 direction = value.vector();
  if (direction == glm::dvec3(0)) fail(value.place(), "a light's direction is zero; give it one");
  return direction;
}

Light read_light(const JsonView& value) {
  Light light;
  JsonFields fields(value);
  fields.read("type", light.type, read_light_type);
  if (light.type == Light::Type::point)
    fields.read("position", light.position, &JsonView::vector);
  else
    fields.read("direction", light.direction, read_direction);
  fields.read("color", light.color, &JsonView::color);
  fields.finish();
  return light;
}

Material read_material(const JsonView& value) {
  Material material;
  JsonFields fields(value);
  fields.read("color", material.color, &JsonView::color);
  fields.read("ambient", material.ambient, &JsonView::factor);
  fields.read("diffuse", material.diffuse, &JsonView::factor);
  fields.read("specular", material.specular, &JsonView::factor);
  fields.read("shininess", material.shininess, &JsonView::factor);
  fields.read("reflect", material.reflect, &JsonView::factor);
  fields.read("transmit", material.transmit, &JsonView::factor);
  fields.read("ior", material.ior, &JsonView::factor);
  fields.finish();
  if (material.ior == 0) fail(value.place(), "an index of refraction is zero; that of glass is 1.5");
  return material;
}

JsonObjects::MaterialIndices read_materials(const std::optional<JsonView>& value, std::vector<Material>& materials) {
  JsonObjects::MaterialIndices indices;
  if (!value) return indices;
  for (const JsonView& member : value->members()) {
    indices.emplace(member.name(), static_cast<std::uint32_t>(materials.size()));
    materials.push_back(read_material(member));
  }
  return indices;
}

}  // namespace

Scene load_json(const std::filesystem::path& file) {
  const JsonValue document = read_json(file);
  const std::filesystem::path folder = file.parent_path();
  Scene scene;
  JsonFields fields({file, document, "scene"});
  bool has_camera = false;
  fields.read("camera", has_camera, [&](const JsonView& value) { return read_camera(value, scene.camera); });
  fields.read("background", scene.background, [&](const JsonView& value) { return read_background(value, folder); });
  if (const auto lights = fields.find("lights"))
    for (const JsonView& light : lights->list()) scene.lights.push_back(read_light(light));
  const auto materials = read_materials(fields.find("materials"), scene.materials);
  JsonObjects objects(folder, materials, fields.find("groups"), scene.notes);
  const JsonView list = fields.need("objects");
  fields.finish();
  scene.geometry = objects.build(list);
  objects.build_groups();
  complete(scene, has_camera);
  return scene;
}

}  // namespace rayengine
