#include "cpu/reference/quadric.h"

#include <algorithm>
#include <optional>

namespace rayengine::reference {
namespace {

template <class T>
using Point = std::array<T, 4>;  // homogeneous

/// Row and column of Q in the upper triangle A..J.
constexpr std::size_t entry_of[4][4] = {{0, 1, 2, 3}, {1, 4, 5, 6}, {2, 5, 7, 8}, {3, 6, 8, 9}};

/// x^T Q y; most entries of unit primitives are zero.
template <class T>
T product(const QuadricMatrix& q, const Point<T>& x, const Point<T>& y) {
  T sum(0.0);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      if (const double entry = q[entry_of[i][j]]; entry != 0) sum = sum + T(entry) * x[i] * y[j];
  return sum;
}

template <class T>
Point<T> origin_of(const Line<T>& line) {
  return {line.origin.x, line.origin.y, line.origin.z, T(1.0)};
}
template <class T>
Point<T> direction_of(const Line<T>& line) {
  return {line.direction.x, line.direction.y, line.direction.z, T(0.0)};
}

Vector<quad> at(const LocalRay& ray, quad t) {
  const auto& [o, d] = ray.value;
  return {o.x + t * d.x, o.y + t * d.y, o.z + t * d.z};
}

const QuadricMatrix& matrix_of(const Geometry& geometry, const Quadric& quadric) {
  static const auto units = [] {
    std::array<QuadricMatrix, quadric_type_count> all;
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = unit_matrix(static_cast<QuadricType>(i));
    return all;
  }();
  return quadric.type == QuadricType::general ? geometry.forms[quadric.form].matrix
                                              : units[static_cast<std::size_t>(quadric.type)];
}

/// What the surface is cut to beside the planes zmin and zmax.
Box box_of(const Geometry& geometry, const Quadric& quadric) {
  if (quadric.type == QuadricType::general) return geometry.forms[quadric.form].box;
  if (quadric.type == QuadricType::saddle) return {glm::dvec3(-1), glm::dvec3(1)};
  return {glm::dvec3(-infinity), glm::dvec3(infinity)};
}

/// What the whole surface is cut to.
Box clip_of(const Geometry& geometry, const Quadric& quadric) {
  Box box = box_of(geometry, quadric);
  box.lower.z = std::max(box.lower.z, quadric.zmin);
  box.upper.z = std::min(box.upper.z, quadric.zmax);
  return box;
}

/// a, b and c of a t^2 + 2 b t + c along a line.
template <class T>
std::array<T, 3> coefficients(const QuadricMatrix& q, const Line<T>& line) {
  const Point<T> o = origin_of(line), d = direction_of(line);
  return {product(q, d, d), product(q, o, d), product(q, o, o)};
}

template <class T>
const T& component(const Vector<T>& v, int axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/// The sign of one coordinate of a root's point less `limit`, which is finite.
int exact_side(const LocalRay& ray, const QuadricMatrix& q, bool rising, int axis, double limit) {
  const Line<Exact> line = ray.exact();
  const Exact height = Exact(limit) - component(line.origin, axis);
  const Exact& slope = component(line.direction, axis);
  if (slope.sign() == 0) return -height.sign();
  const auto [a, b, c] = coefficients(q, line);
  return compare(Root{a, b, c, rising}, height, slope) * slope.sign();
}

/// Of a root that is on the side, by its `rising`.
int side(const LocalRay& ray, const QuadricMatrix& q, const Crossing& crossing, int axis, double limit) {
  if (std::isinf(limit)) return limit > 0 ? -1 : 1;
  const quad along = component(ray.value.direction, axis);
  const quad difference = component(ray.value.origin, axis) + crossing.t * along - limit;
  const long double error =
      crossing.error * size_of(along) +
      quad_rounding * (component(ray.size.origin, axis).value +
                       size_of(crossing.t) * component(ray.size.direction, axis).value + std::abs(limit));
  return size_of(difference) > error ? sign(difference) : exact_side(ray, q, crossing.rising, axis, limit);
}

/// Whether a root's point lies in the box or on it.
bool within(const LocalRay& ray, const QuadricMatrix& q, const Box& box, const Crossing& crossing) {
  for (int axis = 0; axis < 3; ++axis)
    if (side(ray, q, crossing, axis, box.lower[axis]) < 0 || side(ray, q, crossing, axis, box.upper[axis]) > 0)
      return false;
  return true;
}

/// Whether a root's point is not on a rim, or the line enters, or leaves, both the form and the slab there.
bool crosses_solid(const LocalRay& ray, const QuadricMatrix& q, const Quadric& quadric, const Crossing& crossing) {
  const bool lower = side(ray, q, crossing, 2, quadric.zmin) == 0;
  if (!lower && side(ray, q, crossing, 2, quadric.zmax) != 0) return true;
  return ray.exact().direction.z.sign() == (crossing.rising == lower ? -1 : 1);
}

Crossing quotient(const Estimate& n, const Estimate& d) {
  const quad t = n.value / d.value;
  return {t, (n.error + size_of(t) * d.error) / size_of(d.value) + quad_rounding * size_of(t)};
}

/// a t^2 + 2 b t + c, the form along a line.
struct Quadratic {
  Estimate a, b, c, discriminant;

  Quadratic(const LocalRay& ray, const QuadricMatrix& q) {
    const auto all = estimate<4>(ray, [&]<class T>(const Line<T>& line) {
      const auto [a, b, c] = coefficients(q, line);
      return std::array<T, 4>{a, b, c, b * b - a * c};
    });
    a = all[0], b = all[1], c = all[2], discriminant = all[3];
  }
};

void cross_side(const LocalRay& ray, const Geometry& geometry, const Quadric& quadric, const Quadratic& form,
                Crossings& crossings) {
  const auto& [a, b, c, discriminant] = form;
  if (discriminant.value <= 0) return;
  const QuadricMatrix& q = matrix_of(geometry, quadric);
  const quad root = sqrtq(discriminant.value);
  const long double root_error = discriminant.error / size_of(root) + quad_rounding * size_of(root);
  const bool plus = b.value < 0;  // which of the two roots does not cancel
  const Estimate r{plus ? root - b.value : -(root + b.value), root_error + b.error};
  const Box clip = clip_of(geometry, quadric);
  const auto add = [&](Crossing crossing, bool rising) {
    crossing.rising = rising;
    if (!within(ray, q, clip, crossing)) return;
    if (quadric.capped) crossing.counts = crosses_solid(ray, q, quadric, crossing);
    crossings.add(crossing);
  };
  if (a.value != 0) add(quotient(r, a), plus);
  add(quotient(c, r), !plus);
}

/// What a plane across z is cut to: where the form is not positive.
struct Part {
  const QuadricMatrix* form;
  bool rim_counts;
};

template <class T>
std::array<T, 2> plane_t(const Line<T>& line, double z) {
  return {T(z) - line.origin.z, line.direction.z};
}

/// The part of the plane at `z`, or all of it.
void cross_plane(const LocalRay& ray, double z, const std::optional<Part>& part, std::uint32_t primitive,
                 Crossings& crossings) {
  const auto [height, slope, side] = estimate<3>(ray, [&]<class T>(const Line<T>& line) {
    const auto [height, slope] = plane_t(line, z);
    const Point<T> p{line.origin.x * slope + height * line.direction.x,
                     line.origin.y * slope + height * line.direction.y, T(z) * slope, slope};
    return std::array<T, 3>{height, slope, part ? product(*part->form, p, p) : T(0.0)};
  });
  if (slope.value == 0 || side.value > 0) return;
  Crossing crossing = quotient(height, slope);
  crossing.primitive = primitive;
  crossing.counts = !part || side.value < 0 || part->rim_counts;
  crossings.add(crossing);
}

/// A cap in a plane that meets the solid in its axis alone is nothing.
void cross_cap(const LocalRay& ray, double z, const Part& part, std::uint32_t primitive, Crossings& crossings) {
  const Point<quad> axis{0, 0, z, 1};
  if (product(*part.form, axis, axis) < 0) cross_plane(ray, z, part, primitive, crossings);
}

void cross_flat(const LocalRay& ray, const Quadric& quadric, Crossings& crossings) {
  static const QuadricMatrix unit_circle = unit_matrix(QuadricType::cylinder);
  if (quadric.zmin > 0 || 0 > quadric.zmax) return;
  const bool disk = quadric.type == QuadricType::disk;
  cross_plane(ray, 0, disk ? std::optional<Part>({&unit_circle, true}) : std::nullopt, 0, crossings);
}

bool is_flat(const Quadric& quadric) { return quadric.type == QuadricType::plane || quadric.type == QuadricType::disk; }

double cap_height(const Quadric& quadric, std::uint32_t primitive) {
  return primitive == 1 ? quadric.zmin : quadric.zmax;
}

}  // namespace

Crossings cross_quadric(const LocalRay& ray, const Geometry& geometry, const Quadric& quadric) {
  Crossings crossings;
  if (is_flat(quadric)) {
    cross_flat(ray, quadric, crossings);
    return crossings;
  }
  const QuadricMatrix& q = matrix_of(geometry, quadric);
  const Quadratic form(ray, q);
  cross_side(ray, geometry, quadric, form, crossings);
  if (!quadric.capped) return crossings;
  const bool touches_from_inside = form.discriminant.value == 0 && form.a.value < 0;
  for (const std::uint32_t cap : {1u, 2u})
    cross_cap(ray, cap_height(quadric, cap), {&q, touches_from_inside}, cap, crossings);
  return crossings;
}

Root exact_t(const Line<Exact>& line, const Geometry& geometry, const Quadric& quadric, const Crossing& crossing) {
  const Line<Exact> local = transformed(line, quadric.to_object);
  if (crossing.primitive == 0 && !is_flat(quadric)) {
    const auto [a, b, c] = coefficients(matrix_of(geometry, quadric), local);
    return {a, b, c, crossing.rising};
  }
  const auto [height, slope] = plane_t(local, is_flat(quadric) ? 0 : cap_height(quadric, crossing.primitive));
  return fraction(height, slope);
}

Vector<quad> normal(const LocalRay& ray, const Geometry& geometry, const Quadric& quadric, const Crossing& crossing) {
  if (crossing.primitive != 0) return {0, 0, crossing.primitive == 1 ? quad(-1) : quad(1)};
  const QuadricMatrix& q = matrix_of(geometry, quadric);
  const Vector<quad> v = at(ray, crossing.t);
  const Point<quad> p{v.x, v.y, v.z, 1};
  return {product(q, {1, 0, 0, 0}, p), product(q, {0, 1, 0, 0}, p), product(q, {0, 0, 1, 0}, p)};
}

}  // namespace rayengine::reference
