// Embree's callbacks for quadrics, compiled once per instruction set (see lanes.inl).

#include <limits>

#include "accel/unit_matrices.h"
#include "cpu/isa/lanes.inl"
#include "cpu/quadric_bucket.h"

namespace rayengine::ISA {
namespace {

template <class REAL>
using Vec3 = kernels::Vec3<REAL>;

/// As many ints as there are lanes of floats (4 bytes) or doubles (8).
template <int bytes>
struct IntLanes {
  typedef int type __attribute__((vector_size(ISA_BYTES)));
};
template <>
struct IntLanes<8> {
  typedef int type __attribute__((vector_size(ISA_BYTES / 2)));
};

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
INLINE void to_object(const WorldToObject& map, Vec3<REAL>& o, Vec3<REAL>& d) {
  const Vec3<REAL> from{o.x - splat<REAL>(map.origin.x), o.y - splat<REAL>(map.origin.y),
                        o.z - splat<REAL>(map.origin.z)};
  o = turned(map, from);
  d = turned(map, d);
}

/// The same where the map is the same scale for all axes; the bits are the same too.
template <class REAL>
INLINE void to_unit_ball(const WorldToObject& map, Vec3<REAL>& o, Vec3<REAL>& d) {
  const REAL k = splat<REAL>(column(map.linear, 0, 0));
  o = scaled(k, {o.x - splat<REAL>(map.origin.x), o.y - splat<REAL>(map.origin.y), o.z - splat<REAL>(map.origin.z)});
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
INLINE Quadratic<REAL> quadratic(const QuadricBucket& bucket, const Quadric& q, const Vec3<REAL>& p,
                                 const Vec3<REAL>& d) {
  if constexpr (type == QuadricType::general) return general_quadratic(bucket.geometry->forms.data()[q.form], p, d);
  constexpr Form m = form<type>();
  Quadratic<REAL> f;
  kernels::diagonal_coefficients(splat<REAL>(m.A), splat<REAL>(m.E), splat<REAL>(m.H), splat<REAL>(m.I),
                                 splat<REAL>(m.J), p, d, f.a, f.b, f.c);
  return f;
}

template <QuadricType type, class REAL>
INLINE REAL clipped(const QuadricBucket& bucket, const Quadric& q, REAL r, const Vec3<REAL>& p, const Vec3<REAL>& d) {
  if constexpr (type == QuadricType::plane) return r;
  if constexpr (type == QuadricType::disk) return kernels::clip_disk(r, p, d);
  Vec3<REAL> lower, upper;
  if constexpr (type == QuadricType::general) {
    const Box& box = bucket.geometry->forms.data()[q.form].box;
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

template <int kind, class REAL>
INLINE Crossings<REAL> crossings(const QuadricBucket& bucket, const Quadric& q, const Rays<REAL>& rays) {
  constexpr QuadricType type = type_of(kind);
  Vec3<REAL> o = rays.o, d = rays.d;
  if constexpr (kind == ball_kind)
    to_unit_ball(q.to_object, o, d);
  else
    to_object(q.to_object, o, d);
  Vec3<REAL> p;
  REAL s, near, far;
  kernels::approach(o, d, p, s);
  const Quadratic<REAL> f = quadratic<type>(bucket, q, p, d);
  const REAL largest = splat<REAL>(std::numeric_limits<typename kernels::Scalar<REAL>::type>::max());
  // Most rays that meet a quadric's box pass it by: those are spared the divisions and the root.
  if (none(kernels::both(kernels::discriminant(f.a, f.b, f.c) > 0, rays.active)) && (kind == ball_kind || !q.capped))
    return {largest, largest, largest, largest};
  kernels::roots(f.a, f.b, f.c, near, far);
  Crossings<REAL> found{near, far, largest, largest};
  if (kind != ball_kind) {
    found.near = clipped<type>(bucket, q, near, p, d);
    found.far = clipped<type>(bucket, q, far, p, d);
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
  return {s + found.near, s + found.far, s + found.lower_cap, s + found.upper_cap};
}

template <int kind, class REAL>
INLINE Found<REAL> intersect(const QuadricBucket& bucket, const Quadric& q, const Rays<REAL>& rays) {
  const Crossings<REAL> c = crossings<kind>(bucket, q, rays);
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

/// The smallest float that is not below t.
INLINE float round_up(double t) {
  const float f = static_cast<float>(t);
  if (!(static_cast<double>(f) < t)) return f;
  const float step = (f < 0 ? -f : f) * 0x1p-23f + 0x1p-149f;
  return f + step;
}

/// One call of Embree: where in the context and in its ray packet the lanes are found.
struct Call {
  const QuadricBucket* bucket;
  const Quadric* quadric;
  QuadricContext* context;
  RTCRayN* ray;
  RTCHitN* hit;  // null for occlusion
  const int* valid;
  unsigned N;
  unsigned geom, prim, inst;
};

/// Embree's end of the rays, which a triangle may have brought nearer, in our t.
template <class REAL>
INLINE REAL embree_end(const Call& call, int first) {
  const float* tfar = &RTCRayN_tfar(call.ray, call.N, static_cast<unsigned>(first));
  const QuadricContext& c = *call.context;
  REAL end;
  if constexpr (kernels::is_lanes<REAL>) {
    typedef float Floats __attribute__((vector_size(ISA_BYTES / 2)));
    end = __builtin_convertvector(load<Floats>(tfar), REAL);
  } else {
    end = static_cast<double>(*tfar);
  }
  return load<REAL>(c.shift + first) + end * load<REAL>(c.scale + first);
}

/// Rays in double come from the context; those of instances are taken to the group's space, also in double.
template <class REAL>
INLINE Rays<REAL> gather_double(const Call& call, int first) {
  const QuadricContext& c = *call.context;
  Rays<REAL> rays;
  rays.o = {load<REAL>(c.ox + first), load<REAL>(c.oy + first), load<REAL>(c.oz + first)};
  rays.d = {load<REAL>(c.dx + first), load<REAL>(c.dy + first), load<REAL>(c.dz + first)};
  rays.tmin = load<REAL>(c.tmin + first);
  rays.nearest = kernels::smaller(load<REAL>(c.nearest + first), embree_end<REAL>(call, first));
  rays.object = load<REAL>(c.object + first);
  if (call.inst != RTC_INVALID_GEOMETRY_ID) to_object(c.instances->data()[call.inst].to_group, rays.o, rays.d);
  return rays;
}

/// Single precision takes Embree's rays as they are, within the group's space already.
template <class REAL>
INLINE Rays<REAL> gather_float(const Call& call, int first) {
  const float* ray = reinterpret_cast<const float*>(call.ray);
  const auto row = [&](int field) { return load<REAL>(ray + field * static_cast<int>(call.N) + first); };
  Rays<REAL> rays;
  rays.o = {row(0), row(1), row(2)};
  rays.tmin = row(3);
  rays.d = {row(4), row(5), row(6)};
  rays.nearest = row(8);
  rays.object = REAL{};
  return rays;
}

template <class REAL>
INLINE Rays<REAL> gather(const Call& call, int first) {
  Rays<REAL> rays;
  if constexpr (sizeof(typename kernels::Scalar<REAL>::type) == sizeof(double))
    rays = gather_double<REAL>(call, first);
  else
    rays = gather_float<REAL>(call, first);
  if constexpr (kernels::is_lanes<REAL>) {
    using Ints = typename IntLanes<sizeof(typename kernels::Scalar<REAL>::type)>::type;
    rays.active = __builtin_convertvector(load<Ints>(call.valid + first), kernels::Mask<REAL>);
  } else {
    rays.active = call.valid[first] != 0;
  }
  return rays;
}

template <class T>
INLINE auto lane(const T& value, int i) {
  if constexpr (std::is_arithmetic_v<T>)
    return value;
  else
    return value[i];
}

INLINE void record(const Call& call, unsigned ray, double t, float part, bool exact) {
  QuadricContext& c = *call.context;
  c.nearest[ray] = t;
  c.object[ray] = call.quadric->object;
  RTCRayN_tfar(call.ray, call.N, ray) = exact ? round_up((t - c.shift[ray]) * c.rate[ray]) : static_cast<float>(t);
  RTCHitN_geomID(call.hit, call.N, ray) = call.geom;
  RTCHitN_primID(call.hit, call.N, ray) = call.prim;
  RTCHitN_instID(call.hit, call.N, ray, 0) = call.inst;
  RTCHitN_u(call.hit, call.N, ray) = part;
}

template <int kind, class REAL>
INLINE void closest_lanes(const Call& call, int first) {
  const Rays<REAL> rays = gather<REAL>(call, first);
  if (none(rays.active)) return;
  const Found<REAL> found = intersect<kind>(*call.bucket, *call.quadric, rays);
  if (none(found.hit)) return;
  constexpr bool exact = sizeof(typename kernels::Scalar<REAL>::type) == sizeof(double);
  for (int i = 0; i < lane_count<REAL>; ++i)
    if (lane(found.hit, i)) record(call, first + i, lane(found.t, i), static_cast<float>(lane(found.part, i)), exact);
}

template <int kind, class REAL>
INLINE void any_lanes(const Call& call, int first) {
  const Rays<REAL> rays = gather<REAL>(call, first);
  if (none(rays.active)) return;
  const Found<REAL> found = intersect<kind>(*call.bucket, *call.quadric, rays);
  for (int i = 0; i < lane_count<REAL>; ++i)
    if (lane(found.hit, i)) RTCRayN_tfar(call.ray, call.N, first + i) = -std::numeric_limits<float>::infinity();
}

/// Double counts t as we do; single precision as Embree does.
INLINE double our_t(const Call&, int, double t) { return t; }
INLINE double our_t(const Call& call, int ray, float t) {
  return call.context->shift[ray] + static_cast<double>(t) * call.context->scale[ray];
}

/// All hits: every crossing within the interval goes to the collector, in double or float as the precision has it.
template <int kind, class REAL>
INLINE void collect(const Call& call) {
  const Rays<REAL> rays = gather<REAL>(call, 0);
  const Crossings<REAL> c = crossings<kind>(*call.bucket, *call.quadric, rays);
  const REAL t[4] = {c.near, c.far, c.lower_cap, c.upper_cap};
  for (int i = 0; i < 4; ++i)
    if (t[i] > rays.tmin && t[i] < rays.nearest && t[i] < std::numeric_limits<REAL>::max())
      collect_hit(*call.context->collector, {our_t(call, 0, t[i]), call.geom, call.prim, call.inst,
                                             i < 2 ? 0.f : static_cast<float>(i - 1), 0.f});
}

template <class Arguments>
INLINE Call begin(const Arguments& args, RTCRayN* ray, RTCHitN* hit) {
  const auto* bucket = static_cast<const QuadricBucket*>(args.geometryUserPtr);
  const Quadric* quadric = bucket->geometry->quadrics.data() + bucket->quadrics.data()[args.primID];
  return {bucket,
          quadric,
          reinterpret_cast<QuadricContext*>(args.context),
          ray,
          hit,
          args.valid,
          args.N,
          args.geomID,
          args.primID,
          args.context->instID[0]};
}

/// Whole groups of lanes vectorised; single rays, as Embree traces them outside packets, in scalars.
template <class SCALAR, class Wide, class Narrow>
INLINE void dispatch(const Call& call, Wide&& wide, Narrow&& narrow) {
  constexpr int lanes = ISA_BYTES / sizeof(SCALAR);
  if (call.N % lanes == 0)
    for (unsigned first = 0; first < call.N; first += lanes) wide(first);
  else
    for (unsigned i = 0; i < call.N; ++i)
      if (call.valid[i]) narrow(i);
}

template <int kind, class SCALAR>
void intersect_callback(const RTCIntersectFunctionNArguments* args) {
  const Call call = begin(*args, RTCRayHitN_RayN(args->rayhit, args->N), RTCRayHitN_HitN(args->rayhit, args->N));
  if (call.context->collector) return collect<kind, SCALAR>(call);
  dispatch<SCALAR>(
      call, [&](int first) { closest_lanes<kind, Lanes<SCALAR>>(call, first); },
      [&](int i) { closest_lanes<kind, SCALAR>(call, i); });
}

template <int kind, class SCALAR>
void occluded_callback(const RTCOccludedFunctionNArguments* args) {
  const Call call = begin(*args, args->ray, nullptr);
  dispatch<SCALAR>(
      call, [&](int first) { any_lanes<kind, Lanes<SCALAR>>(call, first); },
      [&](int i) { any_lanes<kind, SCALAR>(call, i); });
}

template <class SCALAR, int... kind>
constexpr QuadricCallbacks table(std::integer_sequence<int, kind...>) {
  return {{intersect_callback<kind, SCALAR>...}, {occluded_callback<kind, SCALAR>...}};
}

}  // namespace

constinit const QuadricCallbacks fast_callbacks = table<float>(std::make_integer_sequence<int, quadric_kind_count>());
constinit const QuadricCallbacks robust_callbacks =
    table<double>(std::make_integer_sequence<int, quadric_kind_count>());

}  // namespace rayengine::ISA
