#include "cpu/reference/quadric.h"

#include <algorithm>

#include "cpu/reference/root.h"

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

int sign(quad x) { return x < 0 ? -1 : x > 0; }

/// The sign of one coordinate of a root's point less `limit`, which is finite.
int exact_side(const LocalRay& ray, const QuadricMatrix& q, bool plus, int axis, double limit) {
  const Line<Exact> line = ray.exact();
  const Exact height = Exact(limit) - component(line.origin, axis);
  const Exact& slope = component(line.direction, axis);
  if (slope.sign() == 0) return -height.sign();
  const auto [a, b, c] = coefficients(q, line);
  return compare(Root{a, b, c, plus}, height, slope) * slope.sign();
}

int side(const LocalRay& ray, const QuadricMatrix& q, const Crossing& crossing, bool plus, int axis, double limit) {
  if (std::isinf(limit)) return limit > 0 ? -1 : 1;
  const quad along = component(ray.value.direction, axis);
  const quad difference = component(ray.value.origin, axis) + crossing.t * along - limit;
  const long double error =
      crossing.error * size_of(along) +
      quad_rounding * (component(ray.size.origin, axis).value +
                       size_of(crossing.t) * component(ray.size.direction, axis).value + std::abs(limit));
  return size_of(difference) > error ? sign(difference) : exact_side(ray, q, plus, axis, limit);
}

/// Whether a root's point lies in the box or on it.
bool within(const LocalRay& ray, const QuadricMatrix& q, const Box& box, const Crossing& crossing, bool plus) {
  for (int axis = 0; axis < 3; ++axis)
    if (side(ray, q, crossing, plus, axis, box.lower[axis]) < 0 ||
        side(ray, q, crossing, plus, axis, box.upper[axis]) > 0)
      return false;
  return true;
}

Crossing quotient(const Estimate& n, const Estimate& d, std::uint32_t primitive) {
  const quad t = n.value / d.value;
  return {t, (n.error + size_of(t) * d.error) / size_of(d.value) + quad_rounding * size_of(t), primitive};
}

void cross_side(const LocalRay& ray, const Geometry& geometry, const Quadric& quadric, Crossings& crossings) {
  const QuadricMatrix& q = matrix_of(geometry, quadric);
  const auto [a, b, c, discriminant] = estimate<4>(ray, [&]<class T>(const Line<T>& line) {
    const auto [a, b, c] = coefficients(q, line);
    return std::array<T, 4>{a, b, c, b * b - a * c};
  });
  if (discriminant.value <= 0) return;
  const quad root = sqrtq(discriminant.value);
  const long double root_error = discriminant.error / size_of(root) + quad_rounding * size_of(root);
  const bool plus = b.value < 0;  // which of the two roots does not cancel
  const Estimate r{plus ? root - b.value : -(root + b.value), root_error + b.error};
  const Box clip = clip_of(geometry, quadric);
  const auto add = [&](const Crossing& crossing, bool plus) {
    if (within(ray, q, clip, crossing, plus)) crossings.add(crossing);
  };
  if (a.value != 0) add(quotient(r, a, 0), plus);
  add(quotient(c, r, 0), !plus);
}

/// The part of the plane at `z` where `inside`, if there is one, is not positive.
void cross_plane(const LocalRay& ray, double z, const QuadricMatrix* inside, std::uint32_t primitive,
                 Crossings& crossings) {
  const auto [height, slope, side] = estimate<3>(ray, [&]<class T>(const Line<T>& line) {
    const T height = T(z) - line.origin.z, slope = line.direction.z;
    const Point<T> p{line.origin.x * slope + height * line.direction.x,
                     line.origin.y * slope + height * line.direction.y, T(z) * slope, slope};
    return std::array<T, 3>{height, slope, inside ? product(*inside, p, p) : T(0.0)};
  });
  if (slope.value != 0 && side.value <= 0) crossings.add(quotient(height, slope, primitive));
}

/// A cap in a plane that meets the solid in its axis alone is nothing.
void cross_cap(const LocalRay& ray, double z, const QuadricMatrix& q, std::uint32_t primitive, Crossings& crossings) {
  const Point<quad> axis{0, 0, z, 1};
  if (product(q, axis, axis) < 0) cross_plane(ray, z, &q, primitive, crossings);
}

void cross_flat(const LocalRay& ray, const Quadric& quadric, Crossings& crossings) {
  static const QuadricMatrix unit_circle = unit_matrix(QuadricType::cylinder);
  if (quadric.zmin <= 0 && 0 <= quadric.zmax)
    cross_plane(ray, 0, quadric.type == QuadricType::disk ? &unit_circle : nullptr, 0, crossings);
}

}  // namespace

Crossings cross_quadric(const LocalRay& ray, const Geometry& geometry, const Quadric& quadric) {
  Crossings crossings;
  if (quadric.type == QuadricType::plane || quadric.type == QuadricType::disk) {
    cross_flat(ray, quadric, crossings);
    return crossings;
  }
  cross_side(ray, geometry, quadric, crossings);
  if (quadric.capped) {
    const QuadricMatrix& q = matrix_of(geometry, quadric);
    cross_cap(ray, quadric.zmin, q, 1, crossings);
    cross_cap(ray, quadric.zmax, q, 2, crossings);
  }
  return crossings;
}

Vector<quad> normal(const LocalRay& ray, const Geometry& geometry, const Quadric& quadric, const Crossing& crossing) {
  if (crossing.primitive != 0) return {0, 0, crossing.primitive == 1 ? quad(-1) : quad(1)};
  const QuadricMatrix& q = matrix_of(geometry, quadric);
  const Vector<quad> v = at(ray, crossing.t);
  const Point<quad> p{v.x, v.y, v.z, 1};
  return {product(q, {1, 0, 0, 0}, p), product(q, {0, 1, 0, 0}, p), product(q, {0, 0, 1, 0}, p)};
}

}  // namespace rayengine::reference
