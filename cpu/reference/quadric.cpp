#include "cpu/reference/quadric.h"

#include <algorithm>

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

bool within(double lower, quad x, double upper) { return lower <= x && x <= upper; }

bool kept(const Geometry& geometry, const Quadric& quadric, const Vector<quad>& p) {
  const Box box = box_of(geometry, quadric);
  return within(box.lower.x, p.x, box.upper.x) && within(box.lower.y, p.y, box.upper.y) &&
         within(std::max(box.lower.z, quadric.zmin), p.z, std::min(box.upper.z, quadric.zmax));
}

Crossing quotient(const Estimate& n, const Estimate& d, std::uint32_t primitive) {
  const quad t = n.value / d.value;
  return {t, (n.error + size_of(t) * d.error) / size_of(d.value) + quad_rounding * size_of(t), primitive};
}

void cross_side(const LocalRay& ray, const Geometry& geometry, const Quadric& quadric, Crossings& crossings) {
  const QuadricMatrix& q = matrix_of(geometry, quadric);
  const auto [a, b, c, discriminant] = estimate<4>(ray, [&]<class T>(const Line<T>& line) {
    const Point<T> o = origin_of(line), d = direction_of(line);
    const T a = product(q, d, d), b = product(q, o, d), c = product(q, o, o);
    return std::array<T, 4>{a, b, c, b * b - a * c};
  });
  if (discriminant.value <= 0) return;
  const quad root = sqrtq(discriminant.value);
  const long double root_error = discriminant.error / size_of(root) + quad_rounding * size_of(root);
  const Estimate r{b.value < 0 ? root - b.value : -(root + b.value), root_error + b.error};
  const auto add = [&](const Crossing& crossing) {
    if (kept(geometry, quadric, at(ray, crossing.t))) crossings.add(crossing);
  };
  if (a.value != 0) add(quotient(r, a, 0));
  add(quotient(c, r, 0));
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
  if (within(quadric.zmin, 0, quadric.zmax))
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
