// Embree's callbacks for quadrics, compiled once per instruction set (see lanes.inl).

#include "cpu/isa/quadric_lanes.inl"
#include "cpu/quadric_bucket.h"

namespace rayengine::ISA {
namespace {

/// As many ints as there are lanes of floats (4 bytes) or doubles (8).
template <int bytes>
struct IntLanes {
  typedef int type __attribute__((vector_size(ISA_BYTES)));
};
template <>
struct IntLanes<8> {
  typedef int type __attribute__((vector_size(ISA_BYTES / 2)));
};

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
    end = __builtin_convertvector(read<Floats>(tfar), REAL);
  } else {
    end = static_cast<double>(*tfar);
  }
  return read<REAL>(c.shift + first) + end * read<REAL>(c.scale + first);
}

/// Rays in double come from the context; those of instances are taken to the group's space, also in double.
template <class REAL>
INLINE Rays<REAL> gather_double(const Call& call, int first) {
  const QuadricContext& c = *call.context;
  Rays<REAL> rays;
  rays.o = {read<REAL>(c.ox + first), read<REAL>(c.oy + first), read<REAL>(c.oz + first)};
  rays.d = {read<REAL>(c.dx + first), read<REAL>(c.dy + first), read<REAL>(c.dz + first)};
  rays.tmin = read<REAL>(c.tmin + first);
  rays.nearest = kernels::smaller(read<REAL>(c.nearest + first), embree_end<REAL>(call, first));
  rays.object = read<REAL>(c.object + first);
  if (call.inst != RTC_INVALID_GEOMETRY_ID) to_object(c.instances->data()[call.inst].to_group, rays.o, rays.d);
  return rays;
}

/// Single precision takes Embree's rays as they are, within the group's space already.
template <class REAL>
INLINE Rays<REAL> gather_float(const Call& call, int first) {
  const float* ray = reinterpret_cast<const float*>(call.ray);
  const auto row = [&](int field) { return read<REAL>(ray + field * static_cast<int>(call.N) + first); };
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
    rays.active = __builtin_convertvector(read<Ints>(call.valid + first), kernels::Mask<REAL>);
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
  const Found<REAL> found = intersect<kind>(*call.bucket->geometry, *call.quadric, rays);
  if (none(found.hit)) return;
  constexpr bool exact = sizeof(typename kernels::Scalar<REAL>::type) == sizeof(double);
  for (int i = 0; i < lane_count<REAL>; ++i)
    if (lane(found.hit, i)) record(call, first + i, lane(found.t, i), static_cast<float>(lane(found.part, i)), exact);
}

template <int kind, class REAL>
INLINE void any_lanes(const Call& call, int first) {
  const Rays<REAL> rays = gather<REAL>(call, first);
  if (none(rays.active)) return;
  const Found<REAL> found = intersect<kind>(*call.bucket->geometry, *call.quadric, rays);
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
  const Crossings<REAL> c = crossings<kind>(*call.bucket->geometry, *call.quadric, rays);
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
