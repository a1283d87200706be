// glTF 2.0: the meshes, camera and lights of the default scene. What follows from glTF's physical model is simplified:
// base colours become Lambert, smooth metal mirrors by metallic * (1 - roughness), and lights, which here do not fade
// with distance, get the brightness that they have at the centre of the scene, the brightest being 1.
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <set>
#include <utility>

#include "accel/tracer.h"
#include "engine/load/complete.h"
#include "engine/load/gltf_accessor.h"
#include "engine/load/gltf_model.h"
#include "engine/load/load.h"

namespace rayengine {
namespace {

template <class T>
const T& at(const std::vector<T>& list, int index, const char* what) {
  if (index < 0 || static_cast<std::size_t>(index) >= list.size())
    throw Error(std::string(what) + " " + std::to_string(index) + " does not exist: save the file anew");
  return list[static_cast<std::size_t>(index)];
}

void expect_finite(const std::vector<double>& numbers, const char* what) {
  for (const double x : numbers)
    if (!std::isfinite(x)) throw Error(std::string("a node has a ") + what + " that is not finite: save the file anew");
}

Affine local_transform(const tinygltf::Node& node) {
  Affine map;
  if (const auto& m = node.matrix; m.size() == 16) {
    expect_finite(m, "matrix");
    map.linear = {m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]};
    map.origin = {m[12], m[13], m[14]};
    return map;
  }
  expect_finite(node.translation, "translation"), expect_finite(node.rotation, "rotation"),
      expect_finite(node.scale, "scale");
  if (const auto& r = node.rotation; r.size() == 4) {
    const glm::dquat turn(r[3], r[0], r[1], r[2]);
    if (glm::dot(turn, turn) > 0) map.linear = glm::mat3_cast(glm::normalize(turn));
  }
  if (const auto& s = node.scale; s.size() == 3)
    for (int k = 0; k < 3; ++k) map.linear[k] *= s[static_cast<std::size_t>(k)];
  if (const auto& t = node.translation; t.size() == 3) map.origin = {t[0], t[1], t[2]};
  return map;
}

/// The corners of a primitive's triangles, by its mode.
std::vector<glm::uvec3> triangles(const std::vector<std::uint32_t>& v, int mode) {
  std::vector<glm::uvec3> list;
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    if (v.size() % 3) throw Error("a list of triangles does not hold three corners for each: save the file anew");
    for (std::size_t i = 0; i < v.size(); i += 3) list.emplace_back(v[i], v[i + 1], v[i + 2]);
  } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
    for (std::size_t i = 0; i + 2 < v.size(); ++i) list.emplace_back(v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]);
  } else {
    for (std::size_t i = 1; i + 1 < v.size(); ++i) list.emplace_back(v[i], v[i + 1], v[0]);
  }
  return list;
}

bool has_triangles(const tinygltf::Primitive& primitive) {
  return primitive.mode >= TINYGLTF_MODE_TRIANGLES && primitive.mode <= TINYGLTF_MODE_TRIANGLE_FAN &&
         primitive.attributes.contains("POSITION");
}

Mesh read_primitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
  Mesh mesh;
  mesh.positions = read_vectors(model, primitive.attributes.at("POSITION"));
  if (const auto normals = primitive.attributes.find("NORMAL"); normals != primitive.attributes.end())
    for (const glm::dvec3& n : read_vectors(model, normals->second)) mesh.normals.emplace_back(n);
  if (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size())
    throw Error("a mesh has not as many normals as positions: save the file anew");
  std::vector<std::uint32_t> corners;
  if (primitive.indices >= 0)
    corners = read_indices(model, primitive.indices);
  else
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) corners.push_back(static_cast<std::uint32_t>(i));
  mesh.triangles = triangles(corners, primitive.mode);
  return mesh;
}

glm::vec3 color_of(const std::vector<double>& rgb) {
  return rgb.size() < 3 ? glm::vec3(1) : glm::max(glm::vec3(rgb[0], rgb[1], rgb[2]), 0.0f);
}

Material read_material(const tinygltf::Material& from) {
  const auto& pbr = from.pbrMetallicRoughness;
  Material material;
  material.color = glm::min(color_of(pbr.baseColorFactor), 1.0f);
  material.reflect = static_cast<float>(std::clamp(pbr.metallicFactor * (1 - pbr.roughnessFactor), 0.0, 1.0));
  material.diffuse = 1 - material.reflect;
  return material;
}

class GltfScene {
 public:
  explicit GltfScene(const tinygltf::Model& model) : model_(model) {
    // Material 0 stays the default, for primitives that name none.
    scene_.materials[0].color = glm::vec3(1);
    for (const tinygltf::Material& material : model.materials) scene_.materials.push_back(read_material(material));
    count_users();
  }

  Scene build() {
    visit([&](const tinygltf::Node& node, const Affine& to_world) {
      if (node.mesh >= 0) add_mesh(node.mesh, to_world);
      if (node.camera >= 0) add_camera(at(model_.cameras, node.camera, "camera"), to_world);
      if (const auto light = node.extensions.find("KHR_lights_punctual"); light != node.extensions.end())
        add_light(light->second, to_world);
      skinned_ |= node.skin >= 0;
    });
    scene_.geometry = builder_.build();
    balance_lights();
    if (!has_camera_) frame();
    complete(scene_, true);
    describe();
    return std::move(scene_);
  }

 private:
  /// Calls for every node of the scene, parents first and in file order, with its transform. No recursion: files may
  /// nest as deep as they like, or in a circle.
  template <class Call>
  void visit(const Call& call) const {
    std::vector<std::pair<int, Affine>> open;
    std::set<int> seen;
    const auto push = [&](const std::vector<int>& nodes, const Affine& to_world) {
      for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) open.emplace_back(*node, to_world);
    };
    push(roots(), {});
    while (!open.empty()) {
      const auto [index, parent_to_world] = open.back();
      open.pop_back();
      const tinygltf::Node& node = at(model_.nodes, index, "node");
      if (!seen.insert(index).second)
        throw Error("node " + std::to_string(index) + " has two parents or is its own: save the file anew");
      const Affine to_world = parent_to_world * local_transform(node);
      call(node, to_world);
      push(node.children, to_world);
    }
  }

  std::vector<int> roots() const {
    if (!model_.scenes.empty()) return at(model_.scenes, std::max(model_.defaultScene, 0), "scene").nodes;
    std::vector<bool> is_child(model_.nodes.size());
    for (const tinygltf::Node& node : model_.nodes)
      for (const int child : node.children)
        at(model_.nodes, child, "node"), is_child[static_cast<std::size_t>(child)] = true;
    std::vector<int> nodes;
    for (std::size_t i = 0; i < is_child.size(); ++i)
      if (!is_child[i]) nodes.push_back(static_cast<int>(i));
    return nodes;
  }

  void count_users() {
    users_.resize(model_.meshes.size());
    groups_.resize(model_.meshes.size());
    visit([&](const tinygltf::Node& node, const Affine&) {
      if (node.mesh >= 0) at(model_.meshes, node.mesh, "mesh"), ++users_[static_cast<std::size_t>(node.mesh)];
    });
  }

  // A mesh of one node is placed by its vertices; one of several is built once and instanced.
  void add_mesh(int index, const Affine& to_world) {
    if (glm::determinant(to_world.linear) == 0) return void(++flattened_);
    const auto i = static_cast<std::size_t>(index);
    if (users_[i] == 1) return add_primitives(builder_, model_.meshes[i], to_world);
    if (!groups_[i]) {
      GeometryBuilder group;
      add_primitives(group, model_.meshes[i], {});
      groups_[i] = group.build();
    }
    if (!groups_[i]->objects.empty()) builder_.add(groups_[i], to_world);
  }

  void add_primitives(GeometryBuilder& builder, const tinygltf::Mesh& mesh, const Affine& to_world) {
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      if (!has_triangles(primitive)) {
        ++without_triangles_;
        continue;
      }
      if (primitive.material != -1) at(model_.materials, primitive.material, "material");
      builder.add(read_primitive(model_, primitive), static_cast<std::uint32_t>(primitive.material + 1), to_world);
    }
  }

  // A camera looks along its -z with y up.
  void add_camera(const tinygltf::Camera& from, const Affine& to_world) {
    const auto& view = from.perspective;
    if (from.type != "perspective") return scene_.notes.push_back("a camera without perspective is not used");
    if (std::exchange(has_camera_, true)) return scene_.notes.push_back("of several cameras the first is used");
    Camera& camera = scene_.camera;
    camera.from = to_world.origin;
    camera.at = to_world.origin - glm::normalize(to_world.linear[2]);
    camera.up = to_world.linear[1];
    camera.fov = glm::degrees(view.yfov);
    if (view.aspectRatio > 0)
      camera.size.x = static_cast<int>(std::clamp(std::round(camera.size.y * view.aspectRatio), 1.0, 65536.0));
    check(camera);
  }

  void add_light(const tinygltf::Value& value, const Affine& to_world) {
    const tinygltf::Light& from =
        at(model_.lights, value.Has("light") ? value.Get("light").GetNumberAsInt() : -1, "light");
    has_spots_ |= from.type == "spot";
    Light light;
    light.type = from.type == "directional" ? Light::Type::directional : Light::Type::point;
    light.position = to_world.origin;
    light.direction = -to_world.linear[2];
    light.color = color_of(from.color) * static_cast<float>(std::max(from.intensity, 0.0));
    scene_.lights.push_back(light);
  }

  void balance_lights() {
    const Box& bounds = scene_.geometry->bounds;
    const glm::dvec3 center = bounds.finite() ? bounds.center() : glm::dvec3(0);
    float brightest = 0;
    for (Light& light : scene_.lights) {
      const glm::dvec3 way = light.position - center;
      const double square = light.type == Light::Type::point ? glm::dot(way, way) : 1;
      if (square > 0) light.color /= static_cast<float>(square);
      brightest = std::max({brightest, light.color.x, light.color.y, light.color.z});
    }
    if (brightest > 0 && std::isfinite(brightest))
      for (Light& light : scene_.lights) light.color /= brightest;
  }

  // The framing camera looks at scenes with z up; these have y up.
  void frame() {
    scene_.camera = framing_camera(scene_.geometry->bounds);
    const glm::dvec3 way = scene_.camera.from - scene_.camera.at;
    scene_.camera.from = scene_.camera.at + glm::dvec3(way.x, way.z, -way.y);
    scene_.camera.up = {0, 1, 0};
    scene_.notes.push_back("the scene has no camera: one that frames it was put in");
  }

  void describe() {
    if (!model_.textures.empty()) scene_.notes.push_back("textures are not used: surfaces have their base colours");
    if (has_spots_) scene_.notes.push_back("spot lights shine in all directions");
    if (flattened_) scene_.notes.push_back(std::to_string(flattened_) + " nodes scaled to no volume are passed over");
    if (skinned_) scene_.notes.push_back("skinned meshes are shown at rest");
    if (without_triangles_)
      scene_.notes.push_back(std::to_string(without_triangles_) + " primitives without triangles are passed over");
  }

  const tinygltf::Model& model_;
  Scene scene_;
  GeometryBuilder builder_;
  std::vector<int> users_;  // nodes by mesh
  std::vector<std::shared_ptr<const Geometry>> groups_;
  int without_triangles_ = 0, flattened_ = 0;
  bool has_camera_ = false, has_spots_ = false, skinned_ = false;
};

}  // namespace

Scene load_gltf(const std::filesystem::path& file) {
  const tinygltf::Model model = read_gltf_model(file);
  try {
    return GltfScene(model).build();
  } catch (const Error& error) {
    throw Error(file.string() + ": " + error.what());
  }
}

}  // namespace rayengine
