// Rays against one quadric with bounds on all rounding, a ray per lane: what is hit for sure, what perhaps, and where.
// The bounds are those of accel/kernels/uncertainty.glsl.

#include "cpu/isa/quadric_lanes.inl"

namespace rayengine::ISA {
namespace {

/// The sums of the magnitudes of a form's coefficients: of x^2 to z^2, of x to z, and of 1.
struct FormSize {
  double squares, linear, constant;
};

INLINE double size_of(double a) { return a < 0 ? -a : a; }

INLINE FormSize size_of(const QuadricMatrix& matrix) {
  const double* m = &matrix.front();
  return {size_of(m[0]) + size_of(m[4]) + size_of(m[7]) + 2 * (size_of(m[1]) + size_of(m[2]) + size_of(m[5])),
          size_of(m[3]) + size_of(m[6]) + size_of(m[8]), size_of(m[9])};
}

/// A ray in a quadric's object space from its closest approach on, and how wrong it is.
template <class REAL>
struct Approach {
  Vec3<REAL> p, d;
  REAL shift, d_size, p_size, p_error;
};

/// What is known of a place on a ray: that it lies inside some bounds, or outside, or neither.
template <class REAL>
struct Verdict {
  kernels::Mask<REAL> inside, outside;
};

template <class REAL>
INLINE Verdict<REAL> meet(const Verdict<REAL>& a, const Verdict<REAL>& b) {
  return {kernels::both(a.inside, b.inside), kernels::either(a.outside, b.outside)};
}

template <class REAL>
INLINE Verdict<REAL> between(double lower, REAL x, double upper, REAL error) {
  return {kernels::both(x >= lower + error, x <= upper - error), kernels::either(x<lower - error, x> upper + error)};
}

/// For a form that is above zero outside.
template <class REAL>
INLINE Verdict<REAL> below_zero(REAL form, REAL error) {
  return {form <= -error, form > error};
}

/// Bounds |x| + |y| of the place at r.
template <class REAL>
INLINE REAL width(const Approach<REAL>& a, REAL r) {
  return kernels::magnitude(a.p.x + r * a.d.x) + kernels::magnitude(a.p.y + r * a.d.y);
}

template <QuadricType type, class REAL>
INLINE Verdict<REAL> certainly_clipped([[maybe_unused]] const Geometry& geometry, [[maybe_unused]] const Quadric& q,
                                       const Approach<REAL>& a, REAL r, REAL r_error) {
  const REAL error = kernels::coordinate_error(r, r_error, a.d_size, a.p_size, a.p_error);
  const auto within = [&](REAL p, REAL d, double lower, double upper) {
    return between(lower, p + r * d, upper, error);
  };
  if constexpr (type == QuadricType::plane) {
    return {r == r, r != r};
  } else if constexpr (type == QuadricType::disk) {
    return below_zero(kernels::disk_form(r, a.p, a.d), kernels::rim_error(width(a, r), error, splat<REAL>(1)));
  } else if constexpr (type == QuadricType::general) {
    const Box& box = geometry.forms.data()[q.form].box;
    return meet(meet(within(a.p.x, a.d.x, box.lower.x, box.upper.x), within(a.p.y, a.d.y, box.lower.y, box.upper.y)),
                within(a.p.z, a.d.z, box.lower.z, box.upper.z));
  } else if constexpr (type == QuadricType::saddle) {
    const double lower = q.zmin > -1 ? q.zmin : -1, upper = q.zmax < 1 ? q.zmax : 1;
    return meet(meet(within(a.p.x, a.d.x, -1, 1), within(a.p.y, a.d.y, -1, 1)), within(a.p.z, a.d.z, lower, upper));
  } else {
    return within(a.p.z, a.d.z, q.zmin, q.zmax);
  }
}

/// A bound on the error of t for a place at r; beyond all numbers where it is not sure.
template <class REAL>
INLINE REAL t_error(const Approach<REAL>& a, REAL r, REAL r_error, const kernels::Mask<REAL>& sure) {
  return kernels::pick(sure, kernels::shifted_error(a.shift, r, r_error),
                       splat<REAL>(std::numeric_limits<double>::infinity()));
}

template <QuadricType type, class REAL, class Admit>
INLINE void certain_cap(const Approach<REAL>& a, double at, double part, const kernels::Mask<REAL>& active,
                        Admit&& admit) {
  constexpr Form m = form<type>();
  const REAL height = splat<REAL>(at) - a.p.z, r = kernels::plane_root(splat<REAL>(at), a.p, a.d);
  const REAL r_error = kernels::plane_error(r, a.d.z, height, a.d_size, a.p_error);
  const auto sure = r_error < splat<REAL>(std::numeric_limits<double>::max());
  const double constant = (size_of(m.H) * at * at + 2 * size_of(m.I * at)) + size_of(m.J);
  const REAL error = kernels::coordinate_error(r, r_error, a.d_size, a.p_size, a.p_error);
  const Verdict<REAL> verdict =
      below_zero(kernels::cap_form(splat<REAL>(m.A), splat<REAL>(m.E), splat<REAL>(m.H), splat<REAL>(m.I),
                                   splat<REAL>(m.J), splat<REAL>(at), r, a.p, a.d),
                 kernels::rim_error(width(a, r), error, splat<REAL>(constant)));
  admit(a.shift + r, t_error(a, r, r_error, sure), kernels::both(active, !kernels::both(sure, verdict.outside)),
        kernels::both(sure, verdict.inside), part);
}

/// The side of a quadric: calls admit(t, error, possible, certain, part) for its roots. Where the near one is hit for
/// sure after tmin, the far one matters only to those who want `every` hit.
template <QuadricType type, bool every, class REAL, class Admit>
INLINE void certain_side(const Geometry& geometry, const Quadric& q, const Approach<REAL>& a, REAL tmin,
                         const kernels::Mask<REAL>& active, Admit&& admit) {
  constexpr bool flat = type == QuadricType::plane || type == QuadricType::disk;
  const FormSize size = type == QuadricType::general ? size_of(geometry.forms.data()[q.form].matrix)
                                                     : size_of(unit_matrices[static_cast<std::size_t>(type)]);
  const Quadratic<REAL> f = quadratic<type>(geometry, q, a.p, a.d);
  REAL ea, eb, ec, near, far;
  kernels::coefficient_errors(splat<REAL>(size.squares), splat<REAL>(size.linear), splat<REAL>(size.constant), a.d_size,
                              a.p_size, a.p_error, ea, eb, ec);
  const REAL under_root = kernels::discriminant(f.a, f.b, f.c);
  const REAL wrong = kernels::discriminant_error(f.a, f.b, f.c, ea, eb, ec);
  const auto possible = kernels::both(active, !(under_root < -wrong));
  if (none(possible)) return;
  const auto real = under_root > 4 * wrong;
  kernels::roots(f.a, f.b, f.c, near, far);
  const auto consider = [&](REAL r, const kernels::Mask<REAL>& possible) {
    const REAL r_error = kernels::root_error(r, f.a, f.b, f.c, ea, eb, ec);
    const auto sure = kernels::both(real, r_error < splat<REAL>(std::numeric_limits<double>::max()));
    Verdict<REAL> verdict{sure, !sure};
    if constexpr (type != QuadricType::sphere)
      verdict = certainly_clipped<type>(geometry, q, a, r, r_error);
    else if (q.zmin > -1 || q.zmax < 1)
      verdict = certainly_clipped<type>(geometry, q, a, r, r_error);
    const REAL t = a.shift + r, error = t_error(a, r, r_error, sure);
    const auto certain = kernels::both(sure, verdict.inside);
    admit(t, error, kernels::both(possible, !kernels::both(sure, verdict.outside)), certain, 0.0);
    return kernels::both(certain, t - error > tmin);
  };
  const auto settled = consider(near, possible);
  const auto open = every ? possible : kernels::both(possible, !settled);
  if (!flat && !none(open)) consider(far, open);
}

/// Calls admit(t, error, possible, certain, part) for every place where rays may meet the quadric. `norm` is the
/// largest row sum of its map's magnitudes; `o_extra` and `d_size` are as in Certainty; for `every` see certain_side.
template <int kind, bool every, class REAL, class Admit>
INLINE void certain_crossings(const Geometry& geometry, const Quadric& q, double norm, const Rays<REAL>& rays,
                              REAL o_extra, REAL d_size, Admit&& admit) {
  constexpr QuadricType type = type_of(kind);
  const bool capped = kind != ball_kind && q.capped;
  auto active = rays.active;
  const REAL o_size = norm * (largest_of(from_origin(q.to_object, rays.o)) + o_extra);
  Approach<REAL> a;
  a.d_size = norm * d_size;
  Vec3<REAL> o = rays.o;
  a.d = rays.d;
  if constexpr (kind == ball_kind)
    to_unit_ball(q.to_object, o, a.d);
  else
    to_object(q.to_object, o, a.d);
  if (is_round(type)) {  // whose caps lie within the same distance
    REAL dd;
    const REAL under_root = kernels::round_discriminant(type == QuadricType::sphere, o, a.d, dd);
    active = kernels::both(!(under_root < -kernels::distance_error(o_size, a.d_size)), active);
    if (none(active)) return;
  }
  kernels::approach(o, a.d, a.p, a.shift);
  a.p_size = largest_of(a.p);
  a.p_error = kernels::approach_error(o_size, a.d_size, a.shift);
  certain_side<type, every>(geometry, q, a, rays.tmin, active, admit);
  if (!capped) return;
  // The apex of a cone is a cap without area.
  if (type != QuadricType::cone || q.zmin != 0) certain_cap<type>(a, q.zmin, 1, active, admit);
  if (type != QuadricType::cone || q.zmax != 0) certain_cap<type>(a, q.zmax, 2, active, admit);
}

}  // namespace
}  // namespace rayengine::ISA
