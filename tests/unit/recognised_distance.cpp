#include "recognised_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "accel/random.h"
#include "engine/measure/rays.h"
#include "engine/tracers.h"

namespace rayengine::test {
namespace {

using enum QuadricType;
using Triangle = std::array<glm::dvec3, 3>;

double to_segment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 along = b - a;
  const double size = glm::dot(along, along);
  const double at = size > 0 ? std::clamp(glm::dot(p - a, along) / size, 0., 1.) : 0;
  return glm::length(p - a - at * along);
}

double to_triangle(const glm::dvec3& p, const Triangle& t) {
  const glm::dvec3 n = glm::cross(t[1] - t[0], t[2] - t[0]);
  double edges = infinity;
  bool over = glm::dot(n, n) > 0;
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 &a = t[k], &b = t[(k + 1) % 3];
    over = over && glm::dot(glm::cross(b - a, p - a), n) >= 0;
    edges = std::min(edges, to_segment(p, a, b));
  }
  return over ? std::abs(glm::dot(p - t[0], n)) / glm::length(n) : edges;
}

/// Points of the clipped quadric: where chords of its bounds hit it.
std::vector<glm::dvec3> points_on(const RecognisedQuadric& quadric, std::size_t chords) {
  GeometryBuilder builder;
  builder.add(quadric.shape, 0, quadric.to_world);
  const auto geometry = builder.build();
  const auto rays = random_rays(geometry->bounds, chords);
  const HitLists lists = make_tracer("bvh", geometry, {.threads = 1})->all(rays);
  std::vector<glm::dvec3> points;
  for (std::size_t i = 0; i < rays.size(); ++i)
    for (std::size_t k = lists.offsets[i]; k < lists.offsets[i + 1]; ++k) points.push_back(rays[i].at(lists.hits[k].t));
  return points;
}

/// The unit primitive that a general form is, either way round.
QuadricType kind(const QuadricShape& shape) {
  if (shape.type != general) return shape.type;
  for (const QuadricType type : {sphere, cylinder, cone, paraboloid, hyperboloid1, hyperboloid2, saddle, plane}) {
    QuadricMatrix m = unit_matrix(type);
    if (m == *shape.matrix) return type;
    for (double& a : m) a = -a;
    if (m == *shape.matrix) return type;
  }
  return general;
}

struct Extent {
  double low = -infinity, high = infinity;
  glm::dvec2 half{infinity};
};

Extent extent(const QuadricShape& shape) {
  if (shape.clip) return {(*shape.clip)[0], (*shape.clip)[1]};
  if (shape.box) return {shape.box->lower.z, shape.box->upper.z, glm::dvec2(shape.box->upper)};
  return {};
}

double radius_at(QuadricType type, double z) {
  switch (type) {
    case sphere: return std::sqrt(std::max(1 - z * z, 0.));
    case cylinder: return 1;
    case cone: return std::abs(z);
    case paraboloid: return std::sqrt(std::max(z, 0.));
    case hyperboloid1: return std::sqrt(1 + z * z);
    default: return std::sqrt(std::max(z * z - 1, 0.));
  }
}

/// The point of a cap above or below, or its rim's nearest.
glm::dvec3 on_cap(QuadricType type, double end, const glm::dvec3& p) {
  const double shrink = std::min(1., radius_at(type, end) / std::hypot(p.x, p.y));
  return {shrink * p.x, shrink * p.y, end};
}

/// The point of the same height, or of the end's, in the same direction from the axis.
glm::dvec3 across(QuadricType type, const Extent& e, const glm::dvec3& p) {
  const double z = std::clamp(p.z, e.low, e.high), at = std::hypot(p.x, p.y);
  const double radius = radius_at(type, z);
  return {radius / at * p.x, radius / at * p.y, z};
}

/// The point above or below, or above or below the nearest point of the rim.
glm::dvec3 along(QuadricType type, const Extent& e, const glm::dvec3& p) {
  const double rim = type == disk ? 1 : type == plane || type == saddle ? infinity : radius_at(type, e.high);
  const double shrink = std::min(1., rim / std::hypot(p.x, p.y));
  const double x = std::clamp(shrink * p.x, -e.half.x, e.half.x), y = std::clamp(shrink * p.y, -e.half.y, e.half.y);
  const double rr = x * x + y * y;
  switch (type) {
    case cone: return {x, y, std::sqrt(rr)};
    case paraboloid: return {x, y, rr};
    case hyperboloid2: return {x, y, std::sqrt(1 + rr)};
    case saddle: return {x, y, x * x - y * y};
    default: return {x, y, 0};
  }
}

double to_quadric(const RecognisedQuadric& quadric, const glm::dvec3& p) {
  const QuadricType type = kind(quadric.shape);
  const Extent e = extent(quadric.shape);
  const glm::dvec3 q = inverse(quadric.to_world).point(p);
  const auto far = [&](const glm::dvec3& on) { return glm::length(quadric.to_world.vector(on - q)); };
  if (type == sphere && e.low <= -1 && e.high >= 1) return far(glm::normalize(q));
  double least = infinity;
  if (type == sphere || type == cylinder || type == hyperboloid1 || type == cone || type == paraboloid ||
      type == hyperboloid2)
    least = far(across(type, e, q));
  if (type != sphere && type != cylinder && type != hyperboloid1 && !(type == cone && e.low > 0))
    least = std::fmin(least, far(along(type, e, q)));
  if (const glm::dvec3 on = glm::normalize(q); type == sphere && on.z >= e.low && on.z <= e.high)
    least = std::fmin(least, far(on));
  if (quadric.shape.capped)
    for (const double end : {e.low, e.high}) least = std::fmin(least, far(on_cap(type, end, q)));
  return least;
}

std::vector<Triangle> triangles_of(const Mesh& mesh, const RecognisedQuadric& quadric) {
  std::vector<Triangle> triangles;
  for (const std::uint32_t t : quadric.triangles) {
    const glm::uvec3& v = mesh.triangles[t];
    triangles.push_back({mesh.positions[v.x], mesh.positions[v.y], mesh.positions[v.z]});
  }
  return triangles;
}

/// Inside, on an edge, or a corner.
glm::dvec3 point_of(const Triangle& t, Random& random) {
  double u = random.unit(), v = random.unit();
  if (u + v > 1) u = 1 - u, v = 1 - v;
  const std::size_t where = random.below(4);
  if (where < 2) v = 0;
  if (where < 1) u = 0;
  const std::size_t k = random.below(3);
  return t[k] + u * (t[(k + 1) % 3] - t[k]) + v * (t[(k + 2) % 3] - t[k]);
}

}  // namespace

Distances measured(const Mesh& mesh, const RecognisedQuadric& quadric, std::size_t samples) {
  const std::vector<Triangle> triangles = triangles_of(mesh, quadric);
  const std::vector<glm::dvec3> points = points_on(quadric, samples);
  Random random(1, quadric.triangles[0]);
  Distances d{0, 0, points.size()};
  for (std::size_t i = 0; i < samples; ++i)
    d.to_quadric =
        std::fmax(d.to_quadric, to_quadric(quadric, point_of(triangles[random.below(triangles.size())], random)));
  for (const glm::dvec3& p : points) {
    double least = infinity;
    for (const Triangle& t : triangles) least = std::min(least, to_triangle(p, t));
    d.to_mesh = std::max(d.to_mesh, least);
  }
  return d;
}

}  // namespace rayengine::test
