#include "engine/measure/tessellate.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rayengine {
namespace {

constexpr std::size_t most_triangles = 8'000'000;  // what fits a small machine
constexpr double horizon = 1e4;                    // of planes, in their own space

using enum QuadricType;

struct Ring {
  double z, radius;
};

/// One body's triangles and the part that each belongs to.
struct Parts {
  Mesh mesh;
  std::vector<std::uint32_t> parts;

  void add(const glm::uvec3& triangle, std::uint32_t part) {
    mesh.triangles.push_back(triangle);
    parts.push_back(part);
  }
};

std::uint32_t add_ring(Mesh& mesh, const Ring& ring, std::uint32_t segments) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (std::uint32_t k = 0; k < segments; ++k) {
    const double angle = 2 * std::numbers::pi * k / segments;
    mesh.positions.push_back({ring.radius * std::cos(angle), ring.radius * std::sin(angle), ring.z});
  }
  return first;
}

/// Bands between rings; at rings without radius they are fans.
void revolve(Parts& body, const std::vector<Ring>& rings, std::uint32_t segments) {
  for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
    const std::uint32_t low = add_ring(body.mesh, rings[i], segments),
                        high = add_ring(body.mesh, rings[i + 1], segments);
    for (std::uint32_t k = 0; k < segments; ++k) {
      const std::uint32_t next = (k + 1) % segments;
      if (rings[i].radius > 0) body.add({low + k, low + next, high + next}, 0);
      if (rings[i + 1].radius > 0) body.add({low + k, high + next, high + k}, 0);
    }
  }
}

/// Facing up, but for a lower cap, which faces out of its solid.
void add_disk(Parts& body, const Ring& rim, std::uint32_t part, std::uint32_t segments) {
  const std::uint32_t first = add_ring(body.mesh, rim, segments), turn = part == 1;
  for (std::uint32_t k = 1; k + 1 < segments; ++k) body.add({first, first + k + turn, first + k + 1 - turn}, part);
}

/// The surface's distance from the axis at height z.
double radius(QuadricType type, double z) {
  switch (type) {
    case sphere: return std::sqrt(std::max(1 - z * z, 0.));
    case cone: return std::abs(z);
    case paraboloid: return std::sqrt(std::max(z, 0.));
    case hyperboloid1: return std::sqrt(1 + z * z);
    case hyperboloid2: return std::sqrt(std::max(z * z - 1, 0.));
    default: return 1;
  }
}

/// Heights between which rings are spaced well are evenly spaced in this, which grows with z.
double spacing(QuadricType type, double z) {
  switch (type) {
    case sphere: return std::asin(std::clamp(z, -1., 1.));
    case paraboloid: return std::sqrt(std::max(z, 0.));
    case hyperboloid1: return std::asinh(z);
    case hyperboloid2: return std::copysign(std::acosh(std::max(std::abs(z), 1.)), z);
    default: return z;
  }
}
double height(QuadricType type, double s) {
  switch (type) {
    case sphere: return std::sin(s);
    case paraboloid: return s * s;
    case hyperboloid1: return std::sinh(s);
    case hyperboloid2: return std::copysign(std::cosh(s), s);
    default: return s;
  }
}

void add_sheet(Parts& body, QuadricType type, double low, double high, std::uint32_t segments) {
  if (!(low < high)) return;
  const bool straight = type == cylinder || type == cone;
  const std::uint32_t bands = straight ? 1 : std::max(segments / 4, 2u);
  std::vector<Ring> rings;
  for (std::uint32_t i = 0; i <= bands; ++i) {
    const double a = spacing(type, low), b = spacing(type, high);
    const double z = i == 0 ? low : i == bands ? high : height(type, a + (b - a) * i / bands);
    rings.push_back({z, radius(type, z)});
  }
  revolve(body, rings, segments);
}

void add_round(Parts& body, const Quadric& q, std::uint32_t segments) {
  const double low = std::max(q.zmin, q.type == sphere ? -1 : q.type == paraboloid ? 0 : -infinity);
  const double high = std::min(q.zmax, q.type == sphere ? 1 : infinity);
  if (q.type == cone || q.type == hyperboloid2) {  // what does not reach from below to above
    const double inner = q.type == cone ? 0 : 1;
    add_sheet(body, q.type, low, std::min(high, -inner), segments);
    add_sheet(body, q.type, std::max(low, inner), high, segments);
  } else {
    add_sheet(body, q.type, low, high, segments);
  }
  if (!q.capped) return;
  for (const std::uint32_t part : {1u, 2u}) {
    const Ring rim{part == 1 ? q.zmin : q.zmax, radius(q.type, part == 1 ? q.zmin : q.zmax)};
    if (rim.radius > 0) add_disk(body, rim, part, segments);
  }
}

void add_saddle(Parts& body, std::uint32_t segments) {
  const std::uint32_t cells = segments / 2;
  for (std::uint32_t y = 0; y <= cells; ++y)
    for (std::uint32_t x = 0; x <= cells; ++x) {
      const double u = -1 + 2. * x / cells, v = -1 + 2. * y / cells;
      body.mesh.positions.push_back({u, v, u * u - v * v});
      if (x == cells || y == cells) continue;
      const std::uint32_t at = y * (cells + 1) + x, above = at + cells + 1;
      body.add({at, at + 1, above + 1}, 0);
      body.add({at, above + 1, above}, 0);
    }
}

void add_all(Parts& body, const Mesh& mesh) {
  body.mesh = mesh;
  body.parts.assign(mesh.triangles.size(), 0);
}

bool has_end(const Geometry& geometry, const Quadric& q) {
  const bool whole = q.zmin <= -1 && q.zmax >= 1;
  switch (q.type) {
    case sphere:
    case plane:
    case disk: return true;
    case saddle: return whole;
    case paraboloid: return std::isfinite(q.zmax);
    case general: return geometry.forms[q.form].box.finite();
    default: return std::isfinite(q.zmin) && std::isfinite(q.zmax);
  }
}

Parts parts_of(const Geometry& geometry, const Quadric& q, int level) {
  const std::uint32_t segments = 4u << level;
  Parts body;
  switch (q.type) {
    case sphere:
      q.zmin <= -1 && q.zmax >= 1 ? add_all(body, subdivided_sphere(level)) : add_round(body, q, segments);
      break;
    case plane: add_disk(body, {0, std::numbers::sqrt2 * horizon}, 0, 4); break;
    case disk: add_disk(body, {0, 1}, 0, segments); break;
    case saddle: add_saddle(body, segments); break;
    case general: add_all(body, form_mesh(geometry.forms[q.form], static_cast<int>(segments / 2))); break;
    default: add_round(body, q, segments);
  }
  return body;
}

}  // namespace

std::optional<Tessellation> tessellate(const Geometry& geometry, int level) {
  if (geometry.quadrics.empty() || !geometry.instances.empty()) return {};
  if (!std::ranges::all_of(geometry.quadrics, [&](const Quadric& q) { return has_end(geometry, q); })) return {};
  GeometryBuilder builder;
  Tessellation result;
  for (std::uint32_t i = 0; i < geometry.objects.size(); ++i) {
    const Object& object = geometry.objects[i];
    if (object.kind == Object::Kind::mesh) {
      const Mesh mesh = mesh_of(geometry, i);
      builder.add(mesh, object.material);
      result.parts.insert(result.parts.end(), mesh.triangles.size(), no_id);
    } else {
      const Quadric& quadric = geometry.quadrics[object.first];
      const Parts body = parts_of(geometry, quadric, level);
      builder.add(body.mesh, object.material, object_to_world(quadric.to_object));
      result.parts.insert(result.parts.end(), body.parts.begin(), body.parts.end());
    }
    if (result.parts.size() > most_triangles) return {};
  }
  result.geometry = builder.build();
  return result;
}

}  // namespace rayengine
