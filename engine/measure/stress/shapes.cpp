#include "engine/measure/stress/shapes.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace rayengine::stability {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

Body body(const std::string& name, const QuadricShape& shape) {
  if (shape.type == QuadricType::sphere) return {name, shape};
  const Box bounds = alone(shape)->bounds;
  return {name, shape, bounds.center(), 0.5 * glm::length(bounds.size())};
}

std::vector<Body> make_bodies() {
  std::vector<Body> all;
  for (std::size_t i = 0; i < quadric_type_count; ++i) {
    const auto type = static_cast<QuadricType>(i);
    const std::string name(to_string(type));
    if (type == QuadricType::plane || type == QuadricType::general) continue;
    all.push_back(body(name, {.type = type}));
    if (type >= QuadricType::cylinder && type <= QuadricType::hyperboloid2)
      all.push_back(body(name + ", capped", {.type = type, .capped = true}));
  }
  all.push_back(body("general", of_form({1, .25, 0, 0, 2, 0, .5, 1.5, 0, -1}, {{-1, -.5, -1}, {.5, 1, 1}})));
  return all;
}

void add_quad(Mesh& mesh, unsigned a, unsigned b, unsigned c, unsigned d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

}  // namespace

std::span<const Body> bodies() {
  static const std::vector<Body> all = make_bodies();
  return all;
}

std::shared_ptr<const Geometry> alone(const QuadricShape& shape, const Affine& to_world) {
  GeometryBuilder builder;
  builder.add(shape, 0, to_world);
  return builder.build();
}

std::shared_ptr<const Geometry> alone(const Mesh& mesh, const Affine& to_world) {
  GeometryBuilder builder;
  builder.add(mesh, 0, to_world);
  return builder.build();
}

QuadricShape clipped(QuadricType type, double low, double high, bool capped) {
  return {.type = type, .capped = capped, .clip = std::array{low, high}};
}

QuadricShape of_form(const QuadricMatrix& matrix, const Box& box) {
  return {.type = QuadricType::general, .matrix = matrix, .box = box};
}

Mesh uv_sphere(unsigned stacks, unsigned slices, double radius) {
  Mesh mesh;
  mesh.positions = {{0, 0, radius}, {0, 0, -radius}};
  for (unsigned i = 1; i < stacks; ++i)
    for (unsigned k = 0; k < slices; ++k) {
      const double polar = std::numbers::pi * i / stacks, around = two_pi * k / slices, r = radius * std::sin(polar);
      mesh.positions.push_back({r * std::cos(around), r * std::sin(around), radius * std::cos(polar)});
    }
  const auto at = [=](unsigned ring, unsigned k) { return 2 + (ring - 1) * slices + k % slices; };
  for (unsigned k = 0; k < slices; ++k) {
    mesh.triangles.push_back({0, at(1, k), at(1, k + 1)});
    mesh.triangles.push_back({1, at(stacks - 1, k + 1), at(stacks - 1, k)});
    for (unsigned i = 1; i + 1 < stacks; ++i) add_quad(mesh, at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1));
  }
  return mesh;
}

Mesh fan(unsigned triangles) {
  Mesh mesh{{{0, 0, 0}}, {}, {}};
  for (unsigned i = 0; i < triangles; ++i) {
    mesh.positions.push_back({std::cos(two_pi * i / triangles), std::sin(two_pi * i / triangles), 0});
    mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % triangles});
  }
  return mesh;
}

Mesh bipyramid(unsigned sides, double radius, double height) {
  Mesh mesh{{{0, 0, height}, {0, 0, -height}}, {}, {}};
  for (unsigned i = 0; i < sides; ++i) {
    mesh.positions.push_back({radius * std::cos(two_pi * i / sides), radius * std::sin(two_pi * i / sides), 0});
    const unsigned next = 2 + (i + 1) % sides;
    mesh.triangles.push_back({0, 2 + i, next});
    mesh.triangles.push_back({1, next, 2 + i});
  }
  return mesh;
}

Mesh cube() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.push_back({i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1});
  add_quad(mesh, 0, 2, 3, 1), add_quad(mesh, 4, 5, 7, 6);
  add_quad(mesh, 0, 1, 5, 4), add_quad(mesh, 2, 6, 7, 3);
  add_quad(mesh, 0, 4, 6, 2), add_quad(mesh, 1, 3, 7, 5);
  return mesh;
}

Mesh corner_triangle(double size) { return {{{0, 0, 0}, {size, 0, 0}, {0, size, 0}}, {}, {{0, 1, 2}}}; }

Mesh mapped(Mesh mesh, const Affine& map) {
  for (glm::dvec3& p : mesh.positions) p = map.point(p);
  return mesh;
}

Affine turned(int i) { return Affine::rotate({1, i + .5, 2}, 40 * i + 17); }

std::shared_ptr<const Geometry> mixture(const Affine& to_world) {
  GeometryBuilder builder;
  int i = 0;
  const auto place = [&] {
    ++i;
    const Affine there = Affine::translate({3 * std::cos(i), 3 * std::sin(2 * i), .25 * i});
    return to_world * there * turned(i) * Affine::scale({1 + .25 * (i % 3), 1, 1 - .125 * (i % 4)});
  };
  for (const Body& body : bodies()) builder.add(body.shape, 0, place());
  builder.add(uv_sphere(12, 24), 0, place());
  return builder.build();
}

}  // namespace rayengine::stability
