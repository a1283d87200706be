// Meshes and the edges their triangles share: rows 15 to 18.

#include <glm/geometric.hpp>

#include "engine/measure/stress/aim.h"
#include "engine/measure/stress/families.h"
#include "engine/measure/stress/shapes.h"
#include "engine/measure/stress/text.h"

namespace rayengine::stability {
namespace {

enum Aim : std::size_t { edges, vertices, faces };
constexpr std::pair<Aim, const char*> aims[]{{edges, "edges"}, {vertices, "vertices"}, {faces, "faces"}};

/// From points near `from`, which is inside, at edges, vertices or faces.
Case from_inside(const std::string& name, const Mesh& mesh, const glm::dvec3& from, double near, Aim aim,
                 std::size_t rays, std::uint64_t seed) {
  Case c{
      .variant = name, .geometry = alone(mesh), .size = 0.5 * glm::length(alone(mesh)->bounds.size()), .closed = true};
  c.rays = make_rays(rays, seed, [&](Random& random, std::size_t) {
    return through(from + near * random.unit() * random.direction(), on_triangle(*c.geometry, random, aim));
  });
  return c;
}

/// Splits some triangles' edges by points on them, with triangles without area in between, and repeats a vertex.
Mesh with_flat_triangles(Mesh mesh) {
  const std::size_t count = mesh.triangles.size();
  for (std::size_t i = 0; i < count; i += 3) {
    const glm::uvec3 t = mesh.triangles[i];
    mesh.triangles.push_back({t.x, t.y, t.y});
    mesh.triangles.push_back({t.z, t.z, t.z});
    const auto middle = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.push_back(.5 * mesh.positions[t.x] + .5 * mesh.positions[t.y]);
    mesh.triangles.push_back({t.x, middle, t.y});
  }
  return mesh;
}

}  // namespace

Cases fan_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  for (const auto& [aim, name] : {aims[edges], aims[vertices]})
    for (const bool flat : {true, false}) {
      Case c{.variant = std::string(name) + (flat ? "" : ", tilted"),
             .geometry = alone(fan(6), flat ? Affine{} : turned(5)),
             .closed = true};
      // The centre, or points of the edges that meet there; what lies outside is no shared edge.
      c.rays = make_rays(rays, seed, [&, aim = aim](Random& random, std::size_t) {
        const glm::dvec3 corner = c.geometry->vertex(1 + static_cast<std::uint32_t>(random.below(6)));
        const glm::dvec3 to = aim == vertices ? glm::dvec3(0) : random.between(0, .99) * corner;
        return through(to + random.between(1, 4) * random.direction(), to);
      });
      cases.push_back(c);
    }
  return cases;
}

Cases diagonal_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  for (const double side : {5., 1.}) {
    const Mesh quad{
        {{-side, -side, 0}, {side, -side, 0}, {side, side, 0}, {-side, side, 0}}, {}, {{0, 1, 2}, {0, 2, 3}}};
    Case c{.variant = number("half side = ", side), .geometry = alone(quad), .size = side, .closed = true};
    c.rays = make_rays(rays, seed, [=](Random& random, std::size_t) {
      const double along = random.between(-.99, .99) * side;
      const glm::dvec3 from{random.between(-9, 9), random.between(-9, 9), random.between(1, 10)};
      return through(from, {along, along, 0});
    });
    c.known = {{c.rays.size(), side == 5 ? 10 / .9024725 : 1, 1e-12}};
    const glm::dvec3 tilted{.30458447, .30458447, -.9024725};
    c.rays.push_back(side == 5 ? Ray{{0, 0, 10}, 0, tilted, infinity} : Ray{{0, 0, 1}, 0, {0, 0, -1}, infinity});
    cases.push_back(c);
  }
  return cases;
}

Cases closed_mesh_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  const Mesh sphere = uv_sphere(50, 100);
  for (const double offset : {0., 1e2, 1e4})
    for (const auto& [aim, name] : aims) {
      const glm::dvec3 center(offset, 0, -offset);
      cases.push_back(from_inside(name + number(", offset = ", offset), mapped(sphere, Affine::translate(center)),
                                  center, .5, aim, rays, seed));
    }
  return cases;
}

Cases sliver_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  for (const double aspect : {1e3, 1e5, 1e8}) {
    const Mesh needle = mapped(bipyramid(5, 1 / aspect, 1), turned(1));
    const Mesh sliver = mapped(bipyramid(5, 1, 1 / aspect), turned(1));
    for (const auto& [aim, name] : aims) {
      const auto add = [&, aim = aim, name = name](const char* kind, const Mesh& mesh) {
        cases.push_back(from_inside(kind + number(", aspect = ", aspect) + ", " + name, mesh, glm::dvec3(0),
                                    .1 / aspect, aim, rays, seed));
      };
      add("needle", needle), add("sliver", sliver);
    }
  }
  for (const auto& [aim, name] : aims)
    cases.push_back(from_inside(std::string("without area, ") + name, with_flat_triangles(uv_sphere(12, 24)),
                                glm::dvec3(0), .5, aim, rays, seed));
  return cases;
}

}  // namespace rayengine::stability
