#pragma once

#include <limits>

#include "accel/kernels/kernels.h"

// The arithmetic of solve.h over REAL: double, or lanes of it (see kernels.h), with which code built for one
// instruction set solves several hits at once. Everything is inlined, so that none of that code leaks into another's.
namespace rayengine::formulas {

#define FORMULA         \
  template <class REAL> \
  [[gnu::always_inline]] inline

template <class REAL>
using Vec = kernels::Vec3<REAL>;

inline constexpr double roundoff = 0x1p-53;

/// A bound for n roundings in a row (Higham, "Accuracy and Stability of Numerical Algorithms", lemma 3.1).
consteval double gamma(int n) { return n * roundoff / (1 - n * roundoff); }

FORMULA Vec<REAL> plus(const Vec<REAL>& a, const Vec<REAL>& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
FORMULA Vec<REAL> minus(const Vec<REAL>& a, const Vec<REAL>& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
FORMULA Vec<REAL> times(REAL k, const Vec<REAL>& v) { return {k * v.x, k * v.y, k * v.z}; }
FORMULA Vec<REAL> times(double k, const Vec<REAL>& v) requires kernels::is_lanes<REAL> {
  return {k * v.x, k * v.y, k * v.z};
}
FORMULA Vec<REAL> absolute(const Vec<REAL>& v) {
  return {kernels::magnitude(v.x), kernels::magnitude(v.y), kernels::magnitude(v.z)};
}
FORMULA REAL dot(const Vec<REAL>& a, const Vec<REAL>& b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }
FORMULA Vec<REAL> cross(const Vec<REAL>& a, const Vec<REAL>& b) {
  return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}
FORMULA REAL largest_component(const Vec<REAL>& v) {
  const Vec<REAL> a = absolute(v);
  return kernels::larger(kernels::larger(a.x, a.y), a.z);
}

/// Whether one over the root of a square is what it should be: nothing in it has vanished or overflown.
FORMULA kernels::Mask<REAL> is_regular(REAL square) { return kernels::both(square > 1e-280, square < 1e280); }

/// A world-to-object map: the columns of its matrix.
template <class REAL>
struct Map {
  Vec<REAL> x, y, z, origin;
};
FORMULA Vec<REAL> turned(const Map<REAL>& m, const Vec<REAL>& v) {
  return plus(plus(times(v.x, m.x), times(v.y, m.y)), times(v.z, m.z));
}
FORMULA Vec<REAL> normal_to_world(const Map<REAL>& m, const Vec<REAL>& n) {
  return {dot(m.x, n), dot(m.y, n), dot(m.z, n)};
}

/// A ray in the space of the primitive's geometry, and what taking it there made unsure.
template <class REAL>
struct LocalRay {
  Vec<REAL> origin, direction;
  Vec<REAL> origin_error{REAL{}, REAL{}, REAL{}}, direction_error{REAL{}, REAL{}, REAL{}};
};

/// `ray` taken through a map: five roundings a component, on top of what it brought along.
FORMULA LocalRay<REAL> transformed(const LocalRay<REAL>& ray, const Map<REAL>& m) {
  const Map<REAL> sizes{absolute(m.x), absolute(m.y), absolute(m.z), m.origin};
  const Vec<REAL> from = minus(ray.origin, m.origin);
  return {turned(m, from), turned(m, ray.direction),
          turned(sizes, plus(times(gamma(5), absolute(from)), ray.origin_error)),
          turned(sizes, plus(times(gamma(5), absolute(ray.direction)), ray.direction_error))};
}

/// The ray in object space, its origin moved by `shift` to its closest approach.
template <class REAL>
struct Approach {
  LocalRay<REAL> ray;
  REAL shift;
};

FORMULA Approach<REAL> approach(const Map<REAL>& map, const LocalRay<REAL>& group_ray) {
  const LocalRay<REAL> at_object = transformed(group_ray, map);
  const Vec<REAL>&o = at_object.origin, &d = at_object.direction;
  Approach<REAL> a;
  Vec<REAL> p;
  kernels::approach(o, d, p, a.shift);
  const REAL reach = kernels::magnitude(a.shift);
  // Two steps of a product and a sum each. A rounding of the shift itself only moves p along the ray, and is added to
  // t.
  a.ray = {p, d,
           plus(plus(at_object.origin_error, times(gamma(4), plus(absolute(o), times(reach, absolute(d))))),
                times(reach, at_object.direction_error)),
           at_object.direction_error};
  return a;
}

/// a r^2 + 2 b r + c
template <class REAL>
struct Coefficients {
  REAL a, b, c;
};

/// The form A x^2 + E y^2 + H z^2 + 2 I z + J, which all unit primitives have.
template <class REAL>
struct Diagonal {
  REAL A, E, H, I, J;

  [[gnu::always_inline]] Coefficients<REAL> along(const Vec<REAL>& p, const Vec<REAL>& d) const {
    Coefficients<REAL> k;
    kernels::diagonal_coefficients(A, E, H, I, J, p, d, k.a, k.b, k.c);
    return k;
  }
  [[gnu::always_inline]] void make_absolute() {
    A = kernels::magnitude(A), E = kernels::magnitude(E), H = kernels::magnitude(H);
    I = kernels::magnitude(I), J = kernels::magnitude(J);
  }
  [[gnu::always_inline]] Vec<REAL> quadratic(const Vec<REAL>& v) const { return {A * v.x, E * v.y, H * v.z}; }
  [[gnu::always_inline]] REAL linear(const Vec<REAL>& v) const { return I * v.z; }
  [[gnu::always_inline]] Vec<REAL> gradient(const Vec<REAL>& p) const { return {A * p.x, E * p.y, H * p.z + I}; }
  [[gnu::always_inline]] REAL constant() const { return J; }
};

/// A bound on what all roundings may change in the form's value at p + r d: its coefficients are off by da, db, dc.
template <class Form, class REAL>
[[gnu::always_inline]] inline REAL form_error(Form form, const LocalRay<REAL>& ray, REAL r) {
  form.make_absolute();
  const Vec<REAL> p = absolute(ray.origin), d = absolute(ray.direction);
  const Vec<REAL> gp = form.gradient(p), qd = form.quadratic(d);
  const REAL da = gamma(7) * dot(qd, d) + 2 * dot(qd, ray.direction_error);
  const REAL db = gamma(7) * (dot(qd, p) + form.linear(d)) + dot(qd, ray.origin_error) + dot(gp, ray.direction_error);
  const REAL dc = gamma(8) * (dot(gp, p) + form.linear(p) + form.constant()) + 2 * dot(gp, ray.origin_error);
  return (da * r + 2 * db) * r + dc;
}

/// Where a quadric's side is crossed.
template <class REAL>
struct SideCrossing {
  REAL t, error;       ///< |t - exact t| <= error
  REAL form_error;     ///< times one over the steepest's length, a bound on the distance from the surface
  Vec<REAL> steepest;  ///< the normal in the group's space, not of unit length
};

/// The root that the hit's t is nearest to. With the form off by e at r, r is off by 2 e / (2 |a r + b|) while that
/// slope is large against e; near a tangent, by the square root of e / |a|.
template <class Form, class REAL>
[[gnu::always_inline]] inline SideCrossing<REAL> cross_side(const Form& form, const Map<REAL>& map,
                                                            const LocalRay<REAL>& group_ray, REAL t_guess) {
  const Approach<REAL> k = approach(map, group_ray);
  const auto [a, b, c] = form.along(k.ray.origin, k.ray.direction);
  REAL near, far;
  kernels::roots(a, b, c, near, far);
  const REAL guess = t_guess - k.shift;
  REAL r = kernels::pick(kernels::magnitude(far - guess) < kernels::magnitude(near - guess), far, near);
  const REAL nearest = kernels::pick(a != 0, -b / a, guess);
  r = kernels::pick(kernels::magnitude(r) < std::numeric_limits<double>::max(), r, nearest);

  const REAL e = form_error(form, k.ray, kernels::magnitude(r)), slope = kernels::magnitude(a * r + b);
  const REAL bend = kernels::magnitude(a);
  const REAL along =
      kernels::pick(slope * slope > 4 * bend * e, 2 * e / slope, 2 * slope / bend + kernels::root(e / bend));
  SideCrossing<REAL> s;
  s.t = k.shift + r;
  s.error =
      along + gamma(4) * kernels::magnitude(r) + gamma(2) * (kernels::magnitude(k.shift) + kernels::magnitude(s.t));
  s.form_error = e;
  s.steepest = normal_to_world(map, form.gradient(plus(k.ray.origin, times(r, k.ray.direction))));
  return s;
}

FORMULA Vec<REAL> cross_abs(const Vec<REAL>& a, const Vec<REAL>& b) {
  const auto size = [](const REAL& v) { return kernels::magnitude(v); };
  return {size(a.y * b.z) + size(a.z * b.y), size(a.z * b.x) + size(a.x * b.z), size(a.x * b.y) + size(a.y * b.x)};
}

/// A triangle's plane, n.(a - o) = t n.d on the ray.
template <class REAL>
struct Plane {
  Vec<REAL> ab, ac, n;
  REAL over, under, over_error, under_error;
  REAL sides;    ///< the product of their lengths
  REAL largest;  ///< coordinate of the corners
};

FORMULA Plane<REAL> plane_of(const Vec<REAL>& a, const Vec<REAL>& b, const Vec<REAL>& c, const LocalRay<REAL>& ray) {
  Plane<REAL> k;
  k.ab = minus(b, a), k.ac = minus(c, a);
  const Vec<REAL> bc = minus(c, b), ao = minus(a, ray.origin), n_abs = cross_abs(k.ab, k.ac);
  k.n = cross(k.ab, k.ac);
  k.over = dot(k.n, ao), k.under = dot(k.n, ray.direction);
  k.over_error = gamma(9) * dot(n_abs, absolute(ao)) + dot(n_abs, ray.origin_error);
  k.under_error = gamma(8) * dot(n_abs, absolute(ray.direction)) + dot(n_abs, ray.direction_error);
  k.sides = kernels::root(dot(k.ab, k.ab) * dot(k.ac, k.ac) * dot(bc, bc));
  k.largest = kernels::larger(kernels::larger(largest_component(a), largest_component(b)), largest_component(c));
  return k;
}

/// Where it is crossed, unless that is edge-on: `under` must be more than its own error.
template <class REAL>
struct PlaneCrossing {
  REAL t, error, u, v;
};

/// `unit` is the plane's normal n of unit length, `per_length` one over the length of n.
FORMULA PlaneCrossing<REAL> cross_plane(const Plane<REAL>& k, const Vec<REAL>& a, const LocalRay<REAL>& ray,
                                        const Vec<REAL>& unit, REAL per_length) {
  PlaneCrossing<REAL> x;
  x.t = k.over / k.under;
  const REAL t = kernels::magnitude(x.t);
  x.error = (k.over_error + t * k.under_error) / (kernels::magnitude(k.under) - k.under_error) + roundoff * t;
  const Vec<REAL> p = minus(plus(ray.origin, times(x.t, ray.direction)), a);
  x.u = per_length * dot(unit, cross(p, k.ac));
  x.v = per_length * dot(unit, cross(k.ab, p));
  return x;
}

/// The point at t of a ray, and how far it may be from the surface there, given the two bounds on that which are known:
/// each is infinite where the surface is singular or seen edge-on. The position itself is rounded: a product and a sum
/// of numbers no larger than these.
template <class REAL>
struct Place {
  Vec<REAL> position;
  REAL error;
};
FORMULA Place<REAL> place_at(const LocalRay<REAL>& ray, REAL t, REAL distance, REAL t_error) {
  const Vec<REAL>& d = ray.direction;
  const Vec<REAL> size = absolute(d);
  const REAL bound = kernels::smaller(distance, t_error * ((size.x + size.y) + size.z));
  const REAL rounding = gamma(2) * (largest_component(ray.origin) + kernels::magnitude(t) * largest_component(d));
  const REAL finite = kernels::pick(bound < std::numeric_limits<double>::infinity(), bound, REAL{});
  return {plus(ray.origin, times(t, d)), finite + 2 * rounding};
}

#undef FORMULA

}  // namespace rayengine::formulas
