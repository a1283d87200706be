#include "engine/measure/ralovich_scenes.h"

#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>

#include "accel/tracer.h"

namespace rayengine {
namespace {

constexpr double wall = 5.55;  // the Cornell box, in units of a decimetre
constexpr double turn = 2 * std::numbers::pi;

enum Paint : std::uint32_t { white, red, green, gold };

void add_quad(GeometryBuilder& builder, Paint paint, const glm::dvec3& corner, const glm::dvec3& a,
              const glm::dvec3& b) {
  builder.add(Mesh{{corner, corner + a, corner + a + b, corner + b}, {}, {{0, 1, 2}, {0, 2, 3}}}, paint);
}

/// Floor, ceiling, back and two sides: 10 triangles; open at y = 0.
void add_room(GeometryBuilder& builder) {
  const glm::dvec3 x{wall, 0, 0}, y{0, wall, 0}, z{0, 0, wall};
  add_quad(builder, white, {0, 0, 0}, x, y);
  add_quad(builder, white, z, y, x);
  add_quad(builder, white, y, x, z);
  add_quad(builder, red, {0, 0, 0}, y, z);
  add_quad(builder, green, x, z, y);
}

void add_front(GeometryBuilder& builder) { add_quad(builder, white, {0, 0, 0}, {0, 0, wall}, {wall, 0, 0}); }

void add_lamp(GeometryBuilder& builder) {
  add_quad(builder, white, {2.1, 2.25, 0.999 * wall}, {0, 1.05, 0}, {1.35, 0, 0});
}

/// A block on the floor: 12 triangles.
void add_block(GeometryBuilder& builder, const glm::dvec3& at, double height, double degrees) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.emplace_back(i & 1 ? 0.82 : -0.82, i & 2 ? 0.82 : -0.82, i & 4 ? height : 0);
  for (const auto& q : {std::array{0u, 2u, 3u, 1u}, std::array{4u, 5u, 7u, 6u}, std::array{0u, 1u, 5u, 4u},
                        std::array{2u, 6u, 7u, 3u}, std::array{0u, 4u, 6u, 2u}, std::array{1u, 3u, 7u, 5u}}) {
    mesh.triangles.push_back({q[0], q[1], q[2]});
    mesh.triangles.push_back({q[0], q[2], q[3]});
  }
  builder.add(mesh, white, Affine::translate(at) * Affine::rotate({0, 0, 1}, degrees));
}

/// 2 x `along` x `around` triangles over a grid of points; it closes in itself both ways, or along `around` alone.
Mesh swept(std::uint32_t along, std::uint32_t around, bool closed,
           const std::function<glm::dvec3(double, double)>& point) {
  Mesh mesh;
  const std::uint32_t rows = closed ? along : along + 1;
  for (std::uint32_t i = 0; i < rows; ++i)
    for (std::uint32_t k = 0; k < around; ++k) mesh.positions.push_back(point(double(i) / along, double(k) / around));
  for (std::uint32_t i = 0; i < along; ++i)
    for (std::uint32_t k = 0; k < around; ++k) {
      const std::uint32_t here = i * around, next = (i + 1) % rows * around, beside = (k + 1) % around;
      mesh.triangles.push_back({here + k, here + beside, next + beside});
      mesh.triangles.push_back({here + k, next + beside, next + k});
    }
  return mesh;
}

/// A (2, 3) torus knot: 46 x 11 quads.
Mesh knot() {
  constexpr double thickness = 0.35;
  const auto center = [](double s) {
    const double r = 1.5 + 0.6 * std::cos(3 * turn * s);
    return glm::dvec3(r * std::cos(2 * turn * s), r * std::sin(2 * turn * s), 0.6 * std::sin(3 * turn * s));
  };
  return swept(46, 11, true, [=](double s, double a) {
    const glm::dvec3 along = glm::normalize(center(s + 1e-4) - center(s - 1e-4));
    const glm::dvec3 out = glm::normalize(glm::cross(along, glm::dvec3(0, 0, 1)));
    const glm::dvec3 up = glm::cross(out, along);
    return center(s) + thickness * (std::cos(turn * a) * out + std::sin(turn * a) * up);
  });
}

/// A turned body, 19 x 15 quads, and its head, 4 x 8: 634 triangles.
void add_figure(GeometryBuilder& builder, const glm::dvec3& at) {
  const auto turned = [](auto radius, double height) {
    return [=](double h, double a) {
      return glm::dvec3(radius(h) * std::cos(turn * a), radius(h) * std::sin(turn * a), height * h);
    };
  };
  const auto body = [](double h) { return 0.35 + 0.85 * std::exp(-4 * h) + 0.12 * std::sin(12 * h); };
  const auto head = [](double h) { return 0.02 + 0.65 * std::sin(turn / 2 * h); };
  builder.add(swept(19, 15, false, turned(body, 2.8)), gold, Affine::translate(at));
  builder.add(swept(4, 8, false, turned(head, 1.2)), gold, Affine::translate(at + glm::dvec3(0, 0, 2.7)));
}

Scene lit(GeometryBuilder& builder) {
  Scene scene;
  scene.geometry = builder.build();
  scene.camera = {.from = {wall / 2, -8, wall / 2}, .at = {wall / 2, 0, wall / 2}, .fov = 38};
  scene.lights = {{.position = {wall / 2, wall / 2, 0.95 * wall}}};
  for (const glm::vec3& color : {glm::vec3(.76f, .75f, .72f), glm::vec3(.66f, .08f, .08f), glm::vec3(.12f, .5f, .12f),
                                 glm::vec3(.95f, .66f, .2f)})
    scene.materials.push_back({.color = color, .diffuse = .8f, .specular = .3f, .reflect = .25f});
  scene.materials.erase(scene.materials.begin());
  return scene;
}

/// From within a closed box.
Scene seen_from_inside(Scene scene) {
  scene.camera.from = {0.9 * wall, 0.06 * wall, 0.7 * wall};
  scene.camera.at = {0.4 * wall, 0.6 * wall, 0.35 * wall};
  scene.camera.fov = 70;
  return scene;
}

Scene room() {
  GeometryBuilder builder;
  add_room(builder);
  add_front(builder);
  return seen_from_inside(lit(builder));
}

Scene cornell_box() {
  GeometryBuilder builder;
  add_room(builder);
  add_lamp(builder);
  add_block(builder, {3.7, 1.7, 0}, 1.65, -17);
  add_block(builder, {1.85, 3.5, 0}, 3.3, 17);
  return lit(builder);
}

Scene figure_in_box() {
  GeometryBuilder builder;
  add_room(builder);
  add_front(builder);
  add_figure(builder, {0.45 * wall, 0.6 * wall, 0});
  return seen_from_inside(lit(builder));
}

}  // namespace

Scene cornell_knot() {
  GeometryBuilder builder;
  add_room(builder);
  add_lamp(builder);
  builder.add(knot(), gold, Affine::translate({wall / 2, wall / 2, 2.3}) * Affine::rotate({1, 0, 0}, 62));
  return lit(builder);
}

std::vector<NamedScene> ralovich_scenes() {
  return {{"room", room()},
          {"cornell box", cornell_box()},
          {"figure in box", figure_in_box()},
          {"cornell knot", cornell_knot()}};
}

Scene lit_as_ralovich(Scene scene) {
  if (!scene.geometry->quadrics.empty() || !scene.geometry->instances.empty())
    throw Error("rays in geometry shaders are measured on triangles alone: name a mesh");
  const Camera& c = scene.camera;
  const glm::dvec3 view = c.at - c.from, across = glm::cross(view, glm::normalize(c.up));
  scene.lights = {{.position = c.from + 0.5 * across + 0.5 * glm::length(view) * glm::normalize(c.up)}};
  for (Material& m : scene.materials) m.reflect = .25f, m.transmit = 0;
  return scene;
}

}  // namespace rayengine
