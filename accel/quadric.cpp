#include "accel/quadric.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "accel/unit_matrices.h"

namespace rayengine {
namespace {

constexpr std::array<std::string_view, quadric_type_count> type_names{
    "sphere", "cylinder", "cone", "paraboloid", "hyperboloid1", "hyperboloid2", "saddle", "plane", "disk", "quadric"};

/// A surface of revolution between two clip planes lies in the hull of these two discs.
struct Discs {
  double z0, r0, z1, r1;
};

double radius(QuadricType type, double z) {
  switch (type) {
    case QuadricType::cylinder: return 1;
    case QuadricType::cone: return std::abs(z);
    case QuadricType::paraboloid: return std::sqrt(std::max(z, 0.0));
    case QuadricType::hyperboloid1: return std::sqrt(1 + z * z);
    case QuadricType::hyperboloid2: return std::sqrt(std::max(z * z - 1, 0.0));
    default: return infinity;
  }
}

Discs discs(const Quadric& q) {
  const double r0 = radius(q.type, q.zmin), r1 = radius(q.type, q.zmax), widest = std::max(r0, r1);
  // Where the radius is a convex function of z, every section lies below the chord between the ends.
  const bool convex = q.type != QuadricType::paraboloid && q.type != QuadricType::hyperboloid2;
  return {q.zmin, convex ? r0 : widest, q.zmax, convex ? r1 : widest};
}

/// As std::hypot, which takes five times as long, but for a rounding more; its care is for what over- or underflows.
double length(double a, double b) {
  const double square = a * a + b * b;
  return square > 1e-280 && square < 1e280 ? std::sqrt(square) : std::hypot(a, b);
}

Box bounds_of(const Discs& d, const Affine& map) {
  Box box;
  const auto& m = map.linear;
  for (int i = 0; i < 3; ++i) {
    const double across = length(m[0][i], m[1][i]);
    const auto add_disc = [&](double z, double r) {
      const double center = map.origin[i] + product_or_zero(m[2][i], z), reach = product_or_zero(across, r);
      box.lower[i] = std::min(box.lower[i], center - reach);
      box.upper[i] = std::max(box.upper[i], center + reach);
    };
    add_disc(d.z0, d.r0);
    add_disc(d.z1, d.r1);
  }
  return box;
}

Box sphere_bounds(const Quadric& q, const Affine& map) {
  Box box;
  glm::dvec3 reach;
  for (int i = 0; i < 3; ++i) reach[i] = length(length(map.linear[0][i], map.linear[1][i]), map.linear[2][i]);
  box.add(map.origin - reach);
  box.add(map.origin + reach);
  if (q.zmin <= -1 && q.zmax >= 1) return box;
  const Box clipped = transformed({{-1, -1, std::max(q.zmin, -1.0)}, {1, 1, std::min(q.zmax, 1.0)}}, map);
  return {glm::max(box.lower, clipped.lower), glm::min(box.upper, clipped.upper)};
}

/// Scenes of many spheres are common, and no matrix need be inverted for them.
Box ball_bounds(const Quadric& q) {
  const double radius = 1 / std::abs(q.to_object.linear[0][0]);
  return {q.to_object.origin - radius, q.to_object.origin + radius};
}

}  // namespace

std::string_view to_string(QuadricType type) { return type_names[static_cast<std::size_t>(type)]; }

std::optional<QuadricType> parse_quadric_type(std::string_view name) {
  const auto found = std::find(type_names.begin(), type_names.end(), name);
  if (found == type_names.end()) return std::nullopt;
  return static_cast<QuadricType>(found - type_names.begin());
}

const QuadricMatrix& unit_matrix(QuadricType type) { return unit_matrices[static_cast<std::size_t>(type)]; }

bool is_ball(const Quadric& q) {
  const glm::dmat3& m = q.to_object.linear;
  return q.type == QuadricType::sphere && q.zmin <= -1 && q.zmax >= 1 && m == glm::dmat3(m[0][0]);
}

void add_traits(TraitsByType& traits, std::span<const Quadric> quadrics) {
  for (const Quadric& q : quadrics) {
    QuadricTraits& t = traits[static_cast<std::size_t>(q.type)];
    const bool ball = is_ball(q);
    t.any = true;
    t.clipped |= !ball && (q.zmin > -infinity || q.zmax < infinity);
    t.capped |= q.capped;
    t.balls &= ball;
  }
}

void add_traits(TraitsByType& traits, const TraitsByType& others) {
  for (std::size_t i = 0; i < traits.size(); ++i) {
    traits[i].any |= others[i].any;
    traits[i].clipped |= others[i].clipped;
    traits[i].capped |= others[i].capped;
    traits[i].balls &= others[i].balls;
  }
}

Box bounds(const Quadric& q, const GeneralForm* form) {
  if (is_ball(q)) return ball_bounds(q);
  const Affine map = object_to_world(q.to_object);
  switch (q.type) {
    case QuadricType::sphere: return sphere_bounds(q, map);
    case QuadricType::general: return transformed(form->box, map);
    case QuadricType::saddle:
      return transformed({{-1, -1, std::max(q.zmin, -1.0)}, {1, 1, std::min(q.zmax, 1.0)}}, map);
    case QuadricType::plane: return transformed({{-infinity, -infinity, 0}, {infinity, infinity, 0}}, map);
    default: break;
  }
  return bounds_of(q.type == QuadricType::disk ? Discs{0, 1, 0, 1} : discs(q), map);
}

}  // namespace rayengine
