#include "engine/plan/canonical.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "accel/unit_matrices.h"
#include "engine/plan/costs.h"

namespace rayengine {
namespace {

constexpr double unit = 0x1p-53;          // by which one operation rounds
constexpr double margin = 1 + 64 * unit;  // beyond which a box stays beyond a surface that is rounded

/// Twice a coefficient is on I alone: the places of A, E, H and I, J among the ten.
enum Place { A = 0, E = 4, H = 7, I = 8, J = 9 };

/// A factor of an axis from the form's coefficient and the unit primitive's, both of its square.
struct Scale {
  double factor = 1;
  bool exact = true;
};

bool is_power_of_two(double x) {
  int exponent;
  return std::frexp(x, &exponent) == 0.5;
}

Scale scale_of(double coefficient, double unit_coefficient) {
  const double factor = std::sqrt(coefficient / unit_coefficient);
  return {factor, is_power_of_two(factor) && unit_coefficient * (factor * factor) == coefficient};
}

bool same_sign(double a, double b) { return (a > 0) == (b > 0) && (a < 0) == (b < 0); }

/// The factors along x, y and z that take a form to a positive multiple of a type's; nothing where none do.
std::optional<std::array<Scale, 3>> scales(const QuadricMatrix& form, const QuadricMatrix& to) {
  for (std::size_t i = 0; i < form.size(); ++i)
    if (!same_sign(form[i], to[i])) return {};
  // The coefficient that a scale along x, y and z leaves alone, or may: the constant, then the linear one, then z's.
  const Place fixed = to[J] != 0 ? J : to[I] != 0 ? I : H;
  const double k = form[fixed] / to[fixed];  // exact: the divisor is 1 or a half
  std::array<Scale, 3> result;
  const auto along = [&](int axis, Place p) {
    if (to[p] != 0 && p != fixed) result[axis] = scale_of(form[p], k * to[p]);
  };
  along(0, A), along(1, E), along(2, H);
  return result;
}

bool unlimited(double lower, double upper) { return lower == -infinity && upper == infinity; }

/// Whether an interval holds all of [-1, 1] of the scaled axis.
bool holds_unit(double lower, double upper, const Scale& s) {
  const double reach = s.exact ? 1 : margin;
  return lower * s.factor <= -reach && upper * s.factor >= reach;
}

/// Whether the sides of the box across z leave all of the type, or are those of its own box.
bool same_sides(QuadricType type, const Box& box, const std::array<Scale, 3>& s) {
  for (int axis = 0; axis < 2; ++axis) {
    const double lower = box.lower[axis], upper = box.upper[axis];
    const bool round = type == QuadricType::sphere || type == QuadricType::cylinder;
    const bool own = s[axis].exact && lower * s[axis].factor == -1 && upper * s[axis].factor == 1;
    const bool same =
        type == QuadricType::saddle ? own : unlimited(lower, upper) || (round && holds_unit(lower, upper, s[axis]));
    if (!same) return false;
  }
  return true;
}

/// The clip in the type's own z; nothing where it would be moved by rounding, or the type has none.
std::optional<std::array<double, 2>> clip_of(QuadricType type, const Box& box, const Scale& s) {
  const double lower = box.lower.z, upper = box.upper.z;
  const std::array<double, 2> none{-infinity, infinity};
  if (unlimited(lower, upper) || (type == QuadricType::sphere && holds_unit(lower, upper, s))) return none;
  if (type == QuadricType::plane || !s.exact) return {};
  return std::array{lower * s.factor, upper * s.factor};
}

double norm(const glm::dmat3& m) { return std::sqrt(dot(m[0], m[0]) + dot(m[1], m[1]) + dot(m[2], m[2])); }

/// Bounds how far a surface moves when each entry of its map is rounded by 4 units, to first order, and doubled for the
/// rest: infinite where the surface is.
double distance_moved(const Quadric& q) {
  const Box box = bounds(q, nullptr);
  const glm::dvec3 farthest =
      glm::max(glm::abs(box.lower - q.to_object.origin), glm::abs(box.upper - q.to_object.origin));
  const double condition = norm(q.to_object.linear) * norm(glm::inverse(q.to_object.linear));
  const double distance = 8 * unit * condition * glm::length(farthest);
  return condition * unit < 0x1p-10 && std::isfinite(distance) ? distance : infinity;
}

/// Scales the rows of the map; whether no number left the range in which that is exact to a rounding.
bool scale_rows(glm::dmat3& m, const std::array<Scale, 3>& s) {
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) {
      double& entry = m[column][row];
      if (entry != 0 && !std::isnormal(entry *= s[row].factor)) return false;
    }
  return true;
}

std::optional<CanonicalQuadric> as_type(QuadricType type, const Quadric& general, const GeneralForm& form) {
  const auto s = scales(form.matrix, unit_matrix(type));
  if (!s || !same_sides(type, form.box, *s)) return {};
  const auto clip = clip_of(type, form.box, (*s)[2]);
  if (!clip) return {};
  CanonicalQuadric found{general};
  Quadric& q = found.quadric;
  q.type = type, q.form = no_id, q.zmin = (*clip)[0], q.zmax = (*clip)[1];
  if (!scale_rows(q.to_object.linear, *s)) return {};
  const bool exact = (*s)[0].exact && (*s)[1].exact && (*s)[2].exact;
  found.distance = exact ? 0 : distance_moved(q);
  return found.distance < infinity ? std::optional(found) : std::nullopt;
}

/// What a quadric may be moved by.
double allowed(const Scene& scene, const Quadric& q, const Tolerance& tolerance) {
  ObjectStatistics o;
  o.distance = std::sqrt(bounds(q, nullptr).squared_distance(scene.camera.from));
  return (1 - arithmetic_share) * allowance(tolerance, o, pixel_angle(scene.camera));
}

void bound_again(Geometry& g) {
  g.bounds = g.quadric_bounds = {};
  for (const Quadric& q : g.quadrics) g.quadric_bounds.add(bounds(g, q));
  g.bounds.add(g.quadric_bounds);
  for (const Box& mesh : g.mesh_bounds) g.bounds.add(mesh);
  for (const Instance& i : g.instances) g.bounds.add(bounds(g, i));
}

Choice choice_of(QuadricType type, std::size_t count, double distance) {
  Choice c;
  c.subject = std::to_string(count) + (count == 1 ? " quadric" : " quadrics") + " in general form";
  c.chosen = std::string(to_string(type)) + (count == 1 ? "" : "s");
  c.instead = "as given";
  c.why = distance == 0 ? "their ten numbers are those of that type, on a scale that rounds nothing"
                        : "their ten numbers are those of that type, on a scale along its axes";
  return c;
}

}  // namespace

std::optional<CanonicalQuadric> canonical(const Quadric& general, const GeneralForm& form) {
  for (std::size_t i = 0; i < quadric_type_count; ++i) {
    const auto type = static_cast<QuadricType>(i);
    if (type == QuadricType::disk || type == QuadricType::general) continue;
    if (auto found = as_type(type, general, form)) return found;
  }
  return {};
}

CanonicalScene in_canonical_forms(const Scene& scene, const Tolerance& tolerance) {
  check(tolerance);
  const Geometry& given = *scene.geometry;
  if (given.forms.empty()) return {scene, {}};
  std::shared_ptr<Geometry> made;
  std::array<std::size_t, quadric_type_count> counts{};
  std::array<double, quadric_type_count> distances{};
  for (std::size_t i = 0; i < given.quadrics.size(); ++i) {
    const Quadric& q = given.quadrics[i];
    if (q.type != QuadricType::general) continue;
    const auto found = canonical(q, given.forms[q.form]);
    if (!found || !(found->distance <= (found->distance > 0 ? allowed(scene, found->quadric, tolerance) : 0))) continue;
    if (!made) made = std::make_shared<Geometry>(given);
    made->quadrics[i] = found->quadric;
    const auto type = static_cast<std::size_t>(found->quadric.type);
    ++counts[type];
    distances[type] = std::max(distances[type], found->distance);
  }
  CanonicalScene result{scene, {}};
  if (!made) return result;
  bound_again(*made);
  result.scene.geometry = std::move(made);
  for (std::size_t t = 0; t < counts.size(); ++t)
    if (counts[t] > 0) result.choices.push_back(choice_of(static_cast<QuadricType>(t), counts[t], distances[t]));
  return result;
}

}  // namespace rayengine
