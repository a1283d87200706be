#include <glm/geometric.hpp>
#include <numbers>

#include "engine/measure/purcell.h"

namespace rayengine {
namespace {

enum Finish : std::uint32_t { white, red, green, lamp, gold };

void add_quad(GeometryBuilder& builder, const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v,
              Finish finish) {
  builder.add(Mesh{{corner, corner + u, corner + u + v, corner + v}, {}, {{0, 1, 2}, {0, 2, 3}}}, finish);
}

/// Five walls of a room from 0 to 2, open to -y, and a lamp below the ceiling.
void add_box(GeometryBuilder& builder) {
  const glm::dvec3 x(2, 0, 0), y(0, 2, 0), z(0, 0, 2);
  add_quad(builder, {0, 0, 0}, x, y, white);
  add_quad(builder, z, y, x, white);
  add_quad(builder, y, x, z, white);
  add_quad(builder, {0, 0, 0}, y, z, red);
  add_quad(builder, x, z, y, green);
  add_quad(builder, {0.75, 0.75, 1.99}, {0, 0.5, 0}, {0.5, 0, 0}, lamp);
}

/// On a knot that goes twice round the axis z and three times round the tube of a torus.
glm::dvec3 knot_at(double t) {
  const double around = 4 * std::numbers::pi * t, through = 6 * std::numbers::pi * t;
  const double r = 0.5 + 0.22 * std::cos(through);
  return {r * std::cos(around), r * std::sin(around), 0.22 * std::sin(through)};
}

/// A tube about the knot.
Mesh knot(unsigned rings, unsigned sides, double radius) {
  Mesh mesh;
  for (unsigned i = 0; i < rings; ++i) {
    const double t = static_cast<double>(i) / rings, around = 4 * std::numbers::pi * t;
    const glm::dvec3 center = knot_at(t), along = glm::normalize(knot_at(t + 1e-4) - knot_at(t - 1e-4));
    const glm::dvec3 outward = center - 0.5 * glm::dvec3(std::cos(around), std::sin(around), 0);
    const glm::dvec3 side = glm::normalize(glm::cross(along, outward)), up = glm::cross(side, along);
    for (unsigned k = 0; k < sides; ++k) {
      const double a = 2 * std::numbers::pi * k / sides;
      mesh.positions.push_back(center + radius * (std::cos(a) * side + std::sin(a) * up));
      const unsigned here = i * sides, next = (i + 1) % rings * sides, beside = (k + 1) % sides;
      mesh.triangles.push_back({here + k, here + beside, next + beside});
      mesh.triangles.push_back({here + k, next + beside, next + k});
    }
  }
  return mesh;
}

}  // namespace

Scene cornell_knot() {
  GeometryBuilder builder;
  add_box(builder);
  builder.add(knot(46, 11, 0.11), gold, Affine::translate({1, 1.05, 0.85}) * Affine::rotate({1, 0, 0}, 62));
  Scene scene;
  scene.geometry = builder.build();
  scene.materials = {
      {.color = {.76f, .75f, .72f}, .ambient = .12f, .diffuse = .9f},
      {.color = {.66f, .08f, .08f}, .ambient = .12f, .diffuse = .9f},
      {.color = {.12f, .50f, .12f}, .ambient = .12f, .diffuse = .9f},
      {.color = {1, 1, .9f}, .ambient = 1, .diffuse = 0},
      {.color = {.95f, .66f, .20f}, .ambient = .1f, .diffuse = .7f, .specular = .6f, .shininess = 60, .reflect = .15f}};
  scene.lights = {{Light::Type::point, {1, 1, 1.9}, {}, {.85f, .76f, .62f}},
                  {Light::Type::point, {1, -2.2, 1.15}, {}, {.22f, .22f, .24f}}};
  scene.camera = {.from = {1, -2.9, 1}, .at = {1, 0, 1}, .up = {0, 0, 1}, .fov = 38, .size = {512, 512}};
  return scene;
}

}  // namespace rayengine
