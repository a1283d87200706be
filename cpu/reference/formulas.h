#pragma once

#include <array>
#include <cmath>

#include "accel/ray.h"
#include "accel/transform.h"
#include "cpu/reference/exact.h"

// Formulas that are polynomials in the stored doubles are written once, over a number type T: `quad` gives their value,
// `Magnitude` how large a rounding error that value can carry, and `Exact` the truth when the two are too close to
// tell.
namespace rayengine::reference {

/// What a polynomial comes to when every term is taken positive. Long doubles have the range that products of doubles
/// need.
struct Magnitude {
  long double value;
  explicit Magnitude(double x) : value(std::fabs(x)) {}
  explicit Magnitude(long double x) : value(x) {}

  friend Magnitude operator+(Magnitude a, Magnitude b) { return Magnitude(a.value + b.value); }
  friend Magnitude operator-(Magnitude a, Magnitude b) { return Magnitude(a.value + b.value); }
  friend Magnitude operator*(Magnitude a, Magnitude b) { return Magnitude(a.value * b.value); }
};

template <class T>
struct Vector {
  T x, y, z;
};
template <class T>
Vector<T> make_vector(const glm::dvec3& v) {
  return {T(v.x), T(v.y), T(v.z)};
}
template <class T>
Vector<T> operator-(const Vector<T>& a, const Vector<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
T dot(const Vector<T>& a, const Vector<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
Vector<T> cross(const Vector<T>& a, const Vector<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The sum of factor * coordinate; zero factors, which are many, cost nothing.
template <class T>
T combination(double x, double y, double z, const Vector<T>& v) {
  T sum(0.0);
  if (x != 0) sum = sum + T(x) * v.x;
  if (y != 0) sum = sum + T(y) * v.y;
  if (z != 0) sum = sum + T(z) * v.z;
  return sum;
}

template <class T>
Vector<T> operator*(const glm::dmat3& m, const Vector<T>& v) {
  return {combination(m[0].x, m[1].x, m[2].x, v), combination(m[0].y, m[1].y, m[2].y, v),
          combination(m[0].z, m[1].z, m[2].z, v)};
}

template <class T>
struct Line {
  Vector<T> origin, direction;
};
template <class T>
Line<T> make_line(const Ray& ray) {
  return {make_vector<T>(ray.origin), make_vector<T>(ray.direction)};
}
template <class T>
Line<T> transformed(const Line<T>& line, const WorldToObject& map) {
  return {map.linear * (line.origin - make_vector<T>(map.origin)), map.linear * line.direction};
}

/// A ray as an object or a group sees it, in the number types that formulas want.
class LocalRay {
 public:
  explicit LocalRay(const Ray& ray) : value(make_line<quad>(ray)), size(make_line<Magnitude>(ray)), ray_(&ray) {}
  /// `outer` and `map` must live on.
  LocalRay(const LocalRay& outer, const WorldToObject& map)
      : value(transformed(outer.value, map)), size(transformed(outer.size, map)), outer_(&outer), map_(&map) {}

  Line<Exact> exact() const { return outer_ ? transformed(outer_->exact(), *map_) : make_line<Exact>(*ray_); }

  Line<quad> value;
  Line<Magnitude> size;

 private:
  const Ray* ray_ = nullptr;
  const LocalRay* outer_ = nullptr;
  const WorldToObject* map_ = nullptr;
};

/// Bounds the rounding of a formula of fewer than a hundred operations in a row, relative to its Magnitude: 128 units
/// of 2^-113.
inline constexpr long double quad_rounding = 0x1p-106L;
/// A value smaller than this share of its Magnitude is worked out exactly: so signs are always right.
inline constexpr long double doubtful = 0x1p-66L;

/// A value whose sign is exact.
struct Estimate {
  quad value;
  long double error;  ///< bound on |value - exact value|
};

inline long double size_of(quad x) { return std::fabs(static_cast<long double>(x)); }

/// Evaluates `formulas`, which takes a Line<T> and gives an std::array<T, N>, for the ray.
template <std::size_t N, class Formulas>
std::array<Estimate, N> estimate(const LocalRay& ray, const Formulas& formulas) {
  const std::array<quad, N> values = formulas(ray.value);
  const std::array<Magnitude, N> sizes = formulas(ray.size);
  std::array<Estimate, N> result;
  bool sure = true;
  for (std::size_t i = 0; i < N; ++i) {
    result[i] = {values[i], quad_rounding * sizes[i].value};
    // A formula that is zero term by term has no rounding.
    sure = sure && (size_of(values[i]) > doubtful * sizes[i].value || sizes[i].value == 0);
  }
  if (sure) return result;
  const std::array<Exact, N> exact = formulas(ray.exact());
  for (std::size_t i = 0; i < N; ++i) {
    const quad value = exact[i].rounded();
    result[i] = {value, quad_rounding * size_of(value)};
  }
  return result;
}

/// A place on a ray, at `t` in units of its direction.
struct Crossing {
  quad t;
  long double error;            ///< bound on |t - exact t|
  std::uint32_t primitive = 0;  ///< within its object
  bool rising = false;          ///< of a quadric's side: whether its form rises there, that is, the ray leaves
  bool counts = true;           ///< among all hits; see cross_quadric
};

}  // namespace rayengine::reference
