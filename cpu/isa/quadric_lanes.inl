// Rays against one quadric, a ray per lane, compiled once per instruction set (see lanes.inl).

#include <limits>

#include "accel/geometry.h"
#include "accel/isa/lanes.inl"
#include "accel/unit_matrices.h"
#include "cpu/quadric_kind.h"

namespace rayengine::ISA {
namespace {

template <class REAL>
using Vec3 = kernels::Vec3<REAL>;

/// A ray per lane with the interval that still counts. `object` is that of the nearest hit so far.
template <class REAL>
struct Rays {
  Vec3<REAL> o, d;
  REAL tmin, nearest, object;
  kernels::Mask<REAL> active;
};

/// The nearest hit of one quadric: t, and the part of it (0 side, 1 lower cap, 2 upper cap).
template <class REAL>
struct Found {
  REAL t, part;
  kernels::Mask<REAL> hit;
};

INLINE double column(const glm::dmat3& m, int c, int r) { return (&m[c].x)[r]; }

template <class REAL>
INLINE REAL largest_of(const Vec3<REAL>& v) {
  return kernels::larger(kernels::larger(kernels::magnitude(v.x), kernels::magnitude(v.y)), kernels::magnitude(v.z));
}

template <class REAL>
INLINE Vec3<REAL> turned(const WorldToObject& map, const Vec3<REAL>& v) {
  const auto row = [&](int r) {
    return (splat<REAL>(column(map.linear, 0, r)) * v.x + splat<REAL>(column(map.linear, 1, r)) * v.y) +
           splat<REAL>(column(map.linear, 2, r)) * v.z;
  };
  return {row(0), row(1), row(2)};
}

template <class REAL>
INLINE Vec3<REAL> scaled(REAL k, const Vec3<REAL>& v) {
  return {k * v.x, k * v.y, k * v.z};
}

template <class REAL>
INLINE Vec3<REAL> from_origin(const WorldToObject& map, const Vec3<REAL>& p) {
  return {p.x - splat<REAL>(map.origin.x), p.y - splat<REAL>(map.origin.y), p.z - splat<REAL>(map.origin.z)};
}

template <class REAL>
INLINE void to_object(const WorldToObject& map, Vec3<REAL>& o, Vec3<REAL>& d) {
  o = turned(map, from_origin(map, o));
  d = turned(map, d);
}

/// The same where the map is the same scale for all axes; the bits are the same too.
template <class REAL>
INLINE void to_unit_ball(const WorldToObject& map, Vec3<REAL>& o, Vec3<REAL>& d) {
  const REAL k = splat<REAL>(column(map.linear, 0, 0));
  o = scaled(k, from_origin(map, o));
  d = scaled(k, d);
}

/// Coefficients of a unit primitive's form A x^2 + E y^2 + H z^2 + 2 I z + J.
struct Form {
  double A, E, H, I, J;
};

template <QuadricType type>
constexpr Form form() {
  constexpr QuadricMatrix m = unit_matrices[static_cast<std::size_t>(type)];
  return {m[0], m[4], m[7], m[8], m[9]};
}

/// Keeps the nearest root within the interval. Strictly nearer wins, so that of equal ones the lowest part stays.
template <class REAL>
INLINE void consider(REAL t, double part, const Rays<REAL>& rays, Found<REAL>& best) {
  const auto nearer = kernels::both(t > rays.tmin, t < best.t);
  best.t = kernels::pick(nearer, t, best.t);
  best.part = kernels::pick(nearer, splat<REAL>(part), best.part);
}

/// Coefficients of a r^2 + 2 b r + c = 0 along p + r d.
template <class REAL>
struct Quadratic {
  REAL a, b, c;
};

template <class REAL>
INLINE Quadratic<REAL> general_quadratic(const GeneralForm& g, const Vec3<REAL>& p, const Vec3<REAL>& d) {
  const auto& m = g.matrix;
  const double* q = &m.front();
  Quadratic<REAL> f;
  kernels::general_coefficients(splat<REAL>(q[0]), splat<REAL>(q[1]), splat<REAL>(q[2]), splat<REAL>(q[3]),
                                splat<REAL>(q[4]), splat<REAL>(q[5]), splat<REAL>(q[6]), splat<REAL>(q[7]),
                                splat<REAL>(q[8]), splat<REAL>(q[9]), p, d, f.a, f.b, f.c);
  return f;
}

template <QuadricType type, class REAL>
INLINE Quadratic<REAL> quadratic(const Geometry& geometry, const Quadric& q, const Vec3<REAL>& p, const Vec3<REAL>& d) {
  if constexpr (type == QuadricType::general) return general_quadratic(geometry.forms.data()[q.form], p, d);
  constexpr Form m = form<type>();
  Quadratic<REAL> f;
  kernels::diagonal_coefficients(splat<REAL>(m.A), splat<REAL>(m.E), splat<REAL>(m.H), splat<REAL>(m.I),
                                 splat<REAL>(m.J), p, d, f.a, f.b, f.c);
  return f;
}

template <QuadricType type, class REAL>
INLINE REAL clipped(const Geometry& geometry, const Quadric& q, REAL r, const Vec3<REAL>& p, const Vec3<REAL>& d) {
  if constexpr (type == QuadricType::plane) return r;
  if constexpr (type == QuadricType::disk) return kernels::clip_disk(r, p, d);
  Vec3<REAL> lower, upper;
  if constexpr (type == QuadricType::general) {
    const Box& box = geometry.forms.data()[q.form].box;
    lower = {splat<REAL>(box.lower.x), splat<REAL>(box.lower.y), splat<REAL>(box.lower.z)};
    upper = {splat<REAL>(box.upper.x), splat<REAL>(box.upper.y), splat<REAL>(box.upper.z)};
  } else if constexpr (type == QuadricType::saddle) {
    lower = {splat<REAL>(-1), splat<REAL>(-1), splat<REAL>(q.zmin > -1 ? q.zmin : -1)};
    upper = {splat<REAL>(1), splat<REAL>(1), splat<REAL>(q.zmax < 1 ? q.zmax : 1)};
  } else {
    return kernels::clip_z(r, p, d, splat<REAL>(q.zmin), splat<REAL>(q.zmax));
  }
  return kernels::clip_box(r, p, d, lower, upper);
}

/// All the places where a ray meets one quadric, in its order of parts; the largest number where there is none.
template <class REAL>
struct Crossings {
  REAL near, far, lower_cap, upper_cap;
};

constexpr bool is_round(QuadricType type) { return type == QuadricType::sphere || type == QuadricType::cylinder; }

/// A ray along which roots are sought: t = shift + r at p + r d.
template <class REAL>
struct Line {
  Vec3<REAL> p, d;
  REAL shift;
};

/// Whether no active line comes as near as a round quadric's surface. Its caps lie within the same distance, so what
/// the products round by is given away.
template <bool ball, class REAL>
INLINE bool all_pass_by(const Vec3<REAL>& o, REAL dd, REAL under_root, const kernels::Mask<REAL>& active) {
  constexpr auto unit = std::numeric_limits<typename kernels::Scalar<REAL>::type>::epsilon();
  const REAL across = o.x * o.x + o.y * o.y, oo = ball ? across + o.z * o.z : across;
  return none(kernels::both(!(under_root < -(dd * ((16 * unit) + (16 * unit) * oo))), active));
}

/// Where a line meets the side of a quadric, clips apart; false when no active ray can meet the quadric at all. Most
/// that meet its box pass it by: those are spared the divisions and the root.
template <int kind, class REAL>
INLINE bool meets_side(const Geometry& geometry, const Quadric& q, const kernels::Mask<REAL>& active, Line<REAL>& line,
                       REAL& near, REAL& far) {
  constexpr QuadricType type = type_of(kind);
  const Vec3<REAL> o = line.p;
  if constexpr (is_round(type)) {
    constexpr bool ball = type == QuadricType::sphere;
    REAL dd;
    const REAL under_root = kernels::round_discriminant(ball, o, line.d, dd);
    if (all_pass_by<ball>(o, dd, under_root, active)) return false;
    if (kind == ball_kind || !q.capped) {
      kernels::round_roots(ball, o, line.d, dd, under_root, near, far);
      return true;
    }
  }
  kernels::approach(o, line.d, line.p, line.shift);  // caps, too, are best found from there
  const Quadratic<REAL> f = quadratic<type>(geometry, q, line.p, line.d);
  if (none(kernels::both(kernels::discriminant(f.a, f.b, f.c) > 0, active)) && !q.capped) return false;
  kernels::roots(f.a, f.b, f.c, near, far);
  return true;
}

template <int kind, class REAL>
INLINE Crossings<REAL> crossings(const Geometry& geometry, const Quadric& q, const Rays<REAL>& rays) {
  constexpr QuadricType type = type_of(kind);
  Line<REAL> line{rays.o, rays.d, REAL{}};
  auto &p = line.p, &d = line.d;  // clang 14 captures no structured bindings
  if constexpr (kind == ball_kind)
    to_unit_ball(q.to_object, p, d);
  else
    to_object(q.to_object, p, d);
  const REAL largest = splat<REAL>(std::numeric_limits<typename kernels::Scalar<REAL>::type>::max());
  Crossings<REAL> found{largest, largest, largest, largest};
  if (!meets_side<kind>(geometry, q, rays.active, line, found.near, found.far)) return found;
  if (kind != ball_kind) {
    found.near = clipped<type>(geometry, q, found.near, p, d);
    found.far = clipped<type>(geometry, q, found.far, p, d);
  }
  if (kind != ball_kind && q.capped) {
    constexpr Form m = form<type>();
    const auto cap = [&](double at) {
      return kernels::cap(splat<REAL>(m.A), splat<REAL>(m.E), splat<REAL>(m.H), splat<REAL>(m.I), splat<REAL>(m.J),
                          splat<REAL>(at), p, d);
    };
    // The apex of a cone is a cap without area.
    found.lower_cap = type == QuadricType::cone && q.zmin == 0 ? largest : cap(q.zmin);
    found.upper_cap = type == QuadricType::cone && q.zmax == 0 ? largest : cap(q.zmax);
  }
  // Adding the shift leaves the largest number what it is: no hit.
  return {line.shift + found.near, line.shift + found.far, line.shift + found.lower_cap, line.shift + found.upper_cap};
}

template <int kind, class REAL>
INLINE Found<REAL> intersect(const Geometry& geometry, const Quadric& q, const Rays<REAL>& rays) {
  const Crossings<REAL> c = crossings<kind>(geometry, q, rays);
  const REAL largest = splat<REAL>(std::numeric_limits<typename kernels::Scalar<REAL>::type>::max());
  Found<REAL> best{largest, REAL{}, {}};
  consider(c.near, 0, rays, best);
  consider(c.far, 0, rays, best);
  if (kind != ball_kind && q.capped) {
    consider(c.lower_cap, 1, rays, best);
    consider(c.upper_cap, 2, rays, best);
  }
  const auto tie = kernels::both(best.t == rays.nearest, splat<REAL>(q.object) < rays.object);
  const auto nearer = kernels::either(best.t < rays.nearest, tie);
  best.hit = kernels::both(kernels::both(nearer, best.t < largest), rays.active);
  return best;
}

/// Half the gradient of a quadric's form in object space.
template <QuadricType type, class REAL>
INLINE Vec3<REAL> gradient(const Geometry& geometry, const Quadric& q, const Vec3<REAL>& p) {
  if constexpr (type == QuadricType::general) {
    const auto& matrix = geometry.forms.data()[q.form].matrix;
    const double* m = &matrix.front();
    const auto row = [&](int x, int y, int z, int one) {
      return ((splat<REAL>(m[x]) * p.x + splat<REAL>(m[y]) * p.y) + splat<REAL>(m[z]) * p.z) + splat<REAL>(m[one]);
    };
    return {row(0, 1, 2, 3), row(1, 4, 5, 6), row(2, 5, 7, 8)};
  } else {
    constexpr Form m = form<type>();
    return {splat<REAL>(m.A) * p.x, splat<REAL>(m.E) * p.y, splat<REAL>(m.H) * p.z + splat<REAL>(m.I)};
  }
}

/// Normals where a quadric was hit, in the space of its geometry, their largest component near 1; zero where it is
/// singular.
template <int kind, class REAL>
INLINE Vec3<REAL> outward(const Geometry& geometry, const Quadric& q, const Rays<REAL>& rays,
                          const Found<REAL>& found) {
  constexpr QuadricType type = type_of(kind);
  const WorldToObject& map = q.to_object;
  const REAL t = found.t, one = splat<REAL>(1);
  const Vec3<REAL> at{rays.o.x + t * rays.d.x, rays.o.y + t * rays.d.y, rays.o.z + t * rays.d.z};
  const Vec3<REAL> from = from_origin(map, at);
  if constexpr (kind == ball_kind) return scaled(splat<REAL>(column(map.linear, 0, 0)), from);
  Vec3<REAL> n = gradient<type>(geometry, q, turned(map, from));
  if (q.capped) {
    const auto side = found.part == 0;
    n.x = kernels::pick(side, n.x, REAL{}), n.y = kernels::pick(side, n.y, REAL{});
    n.z = kernels::pick(side, n.z, kernels::pick(found.part == 1, -one, one));
  }
  const auto along = [&](int c) {
    return (splat<REAL>(column(map.linear, c, 0)) * n.x + splat<REAL>(column(map.linear, c, 1)) * n.y) +
           splat<REAL>(column(map.linear, c, 2)) * n.z;
  };
  const Vec3<REAL> world{along(0), along(1), along(2)};
  const REAL largest = largest_of(world);
  return scaled(kernels::pick(largest > 0, one / largest, REAL{}), world);
}

}  // namespace
}  // namespace rayengine::ISA
