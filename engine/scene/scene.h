#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "accel/geometry.h"
#include "engine/scene/image.h"

namespace rayengine {

/// A pinhole camera. `fov` is the full vertical angle in degrees, edge to edge of the outer pixel rows.
struct Camera {
  glm::dvec3 from{0, -6, 2};
  glm::dvec3 at{0, 0, 0};
  glm::dvec3 up{0, 0, 1};
  double fov = 45;
  glm::ivec2 size{512, 512};
};

struct Light {
  enum class Type { point, directional };
  Type type = Type::point;
  glm::dvec3 position{0};          ///< point: where it is
  glm::dvec3 direction{0, 0, -1};  ///< directional: where its light travels; any length
  glm::vec3 color{1};              ///< intensity, without falloff over distance
};

/// Blinn-Phong with Whitted's mirror and glass. `ambient`, `diffuse` and `transmit` multiply `color`, linear RGB;
/// highlights and reflections are not tinted.
struct Material {
  glm::vec3 color{0.8f};
  float ambient = 0;
  float diffuse = 1;
  float specular = 0;
  float shininess = 30;
  float reflect = 0;
  float transmit = 0;
  float ior = 1;
};

/// What rays see that hit nothing: one colour, or a latitude-longitude image (its middle column in +x, its top row in
/// +z).
struct Background {
  glm::vec3 color{0};
  std::shared_ptr<const Image> image;
};

/// All that a picture needs. Object::material indexes `materials`, within groups too.
struct Scene {
  Camera camera;
  Background background;
  std::vector<Light> lights;
  std::vector<Material> materials{Material{}};
  std::shared_ptr<const Geometry> geometry;
  /// The caller's numbers of the geometry's objects, where those are others than their place (see plan/model.h).
  std::vector<std::uint32_t> object_numbers;
  /// Lines for the user: repairs made while loading, a default camera or light that was put in.
  std::vector<std::string> notes;
};

/// What the caller knows a hit's object as, by Scene::object_numbers; no_id stays.
inline std::uint32_t object_number(std::span<const std::uint32_t> numbers, std::uint32_t object) {
  return numbers.empty() || object == no_id ? object : numbers[object];
}

/// Moves a camera to where it frames `bounds` from a corner above; unbounded sides count as the unit box.
Camera framing_camera(const Box& bounds, Camera camera = {});

/// A light at the eye, for scenes without any.
Light headlight(const Camera& camera);

}  // namespace rayengine
