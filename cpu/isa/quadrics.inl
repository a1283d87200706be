// Embree's callbacks for quadrics, compiled once per instruction set (see lanes.inl).

#include "cpu/isa/quadric_lanes.inl"
#include "cpu/packet.h"

namespace rayengine::ISA {
namespace {

/// As many ints, or floats, as there are lanes of REAL.
template <class REAL>
struct Narrow {
  typedef int Ints __attribute__((vector_size(4 * lane_count<REAL>)));
  typedef float Floats __attribute__((vector_size(4 * lane_count<REAL>)));
};
template <class REAL>
using Ints = typename Narrow<REAL>::Ints;
template <class REAL>
using Floats = typename Narrow<REAL>::Floats;

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

/// Where the context holds lanes that begin with Embree's ray `first`.
template <class REAL>
INLINE int place(const Call& call, int first) {
  return kernels::is_lanes<REAL> ? first : first + call.context->lane;
}

/// Embree's end of the rays, which a triangle may have brought nearer, in our t.
template <class REAL>
INLINE REAL embree_end(const Call& call, int first) {
  const float* tfar = &RTCRayN_tfar(call.ray, call.N, static_cast<unsigned>(first));
  const QuadricContext& c = *call.context;
  const int at = place<REAL>(call, first);
  REAL end;
  if constexpr (kernels::is_lanes<REAL>) {
    end = __builtin_convertvector(read<Floats<REAL>>(tfar), REAL);
  } else {
    end = static_cast<double>(*tfar);
  }
  return read<REAL>(c.shift + at) + end * read<REAL>(c.scale + at);
}

/// Rays in double come from the context; those of instances are taken to the group's space, also in double. Who asks
/// for any hit knows that none was found before.
template <class REAL, bool any>
INLINE Rays<REAL> gather_double(const Call& call, int first) {
  const QuadricContext& c = *call.context;
  const int at = place<REAL>(call, first);
  Rays<REAL> rays;
  rays.o = {read<REAL>(c.ox + at), read<REAL>(c.oy + at), read<REAL>(c.oz + at)};
  rays.d = {read<REAL>(c.dx + at), read<REAL>(c.dy + at), read<REAL>(c.dz + at)};
  rays.tmin = read<REAL>(c.tmin + at);
  rays.nearest = read<REAL>(c.nearest + at);
  rays.object = REAL{};
  if (!any) {
    rays.nearest = kernels::smaller(rays.nearest, embree_end<REAL>(call, first));
    rays.object = read<REAL>(c.object + at);
  }
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

template <class REAL, bool any = false>
INLINE Rays<REAL> gather(const Call& call, int first) {
  Rays<REAL> rays;
  if constexpr (sizeof(typename kernels::Scalar<REAL>::type) == sizeof(double))
    rays = gather_double<REAL, any>(call, first);
  else
    rays = gather_float<REAL>(call, first);
  if constexpr (kernels::is_lanes<REAL>) {
    rays.active = __builtin_convertvector(read<Ints<REAL>>(call.valid + first), kernels::Mask<REAL>);
  } else {
    rays.active = call.valid[first] != 0;
  }
  return rays;
}

template <class REAL>
inline constexpr bool is_double = sizeof(typename kernels::Scalar<REAL>::type) == sizeof(double);

// What is recorded of a hit beside its ids takes the places that Embree has for triangles: the normal; `u` is the part,
// `v` holds the bits of the object's id. Makers of hits read them there (see packet.inl).

INLINE void record(const Call& call, unsigned ray, double t, float part, const Vec3<float>& normal, bool exact) {
  QuadricContext& c = *call.context;
  const int at = place<double>(call, static_cast<int>(ray));
  if (exact) c.nearest[at] = t, c.object[at] = call.quadric->object;
  RTCRayN_tfar(call.ray, call.N, ray) = exact ? round_up((t - c.shift[at]) * c.rate[at]) : static_cast<float>(t);
  RTCHitN_Ng_x(call.hit, call.N, ray) = normal.x;
  RTCHitN_Ng_y(call.hit, call.N, ray) = normal.y;
  RTCHitN_Ng_z(call.hit, call.N, ray) = normal.z;
  RTCHitN_u(call.hit, call.N, ray) = part;
  RTCHitN_v(call.hit, call.N, ray) = read<float>(&call.quadric->object);
  RTCHitN_primID(call.hit, call.N, ray) = call.prim;
  RTCHitN_geomID(call.hit, call.N, ray) = call.geom;
  RTCHitN_instID(call.hit, call.N, ray, 0) = call.inst;
}

/// Writes the lanes that were hit.
template <class VALUE, class MASK>
INLINE void put(void* to, MASK hit, VALUE value) {
  write(static_cast<char*>(to), hit ? value : read<VALUE>(static_cast<char*>(to)));
}

/// The smallest floats that are not below t.
template <class REAL>
INLINE Floats<REAL> round_up(REAL t) {
  const Floats<REAL> f = __builtin_convertvector(t, Floats<REAL>);
  const auto below = __builtin_convertvector(__builtin_convertvector(f, REAL) < t, Ints<REAL>);
  return below ? f + (kernels::magnitude(f) * 0x1p-23f + 0x1p-149f) : f;
}

template <class REAL>
INLINE void record(const Call& call, int first, const Found<REAL>& found, const Vec3<REAL>& normal) {
  QuadricContext& c = *call.context;
  const Ints<REAL> hit = __builtin_convertvector(found.hit, Ints<REAL>);
  float* const tfar = &RTCRayN_tfar(call.ray, call.N, static_cast<unsigned>(first));
  if constexpr (is_double<REAL>) {
    put(c.nearest + first, found.hit, found.t);
    put(c.object + first, found.hit, splat<REAL>(call.quadric->object));
    put(tfar, hit, round_up((found.t - read<REAL>(c.shift + first)) * read<REAL>(c.rate + first)));
  } else {
    put(tfar, hit, found.t);
  }
  const auto field = [&](int row) {
    return reinterpret_cast<float*>(call.hit) + (row - normal_x_row) * static_cast<int>(call.N) + first;
  };
  const auto put_real = [&](int i, const REAL& value) {
    put(field(i), hit, __builtin_convertvector(value, Floats<REAL>));
  };
  const auto put_id = [&](int i, unsigned id) { put(field(i), hit, Ints<REAL>{} + static_cast<int>(id)); };
  put_real(normal_x_row, normal.x), put_real(normal_x_row + 1, normal.y), put_real(normal_x_row + 2, normal.z);
  put_real(u_row, found.part);
  put_id(v_row, call.quadric->object);
  put_id(prim_row, call.prim), put_id(geom_row, call.geom), put_id(inst_row, call.inst);
}

template <int kind, class REAL>
INLINE void closest_lanes(const Call& call, int first) {
  const Rays<REAL> rays = gather<REAL>(call, first);
  if (none(rays.active)) return;
  const Found<REAL> found = intersect<kind>(*call.bucket->geometry, *call.quadric, rays);
  if (none(found.hit)) return;
  const Vec3<REAL> normal = outward<kind>(*call.bucket->geometry, *call.quadric, rays, found);
  if constexpr (kernels::is_lanes<REAL>) {
    record(call, first, found, normal);
  } else {
    const auto number = [](REAL a) { return static_cast<float>(a); };
    record(call, static_cast<unsigned>(first), found.t, number(found.part),
           {number(normal.x), number(normal.y), number(normal.z)}, is_double<REAL>);
  }
}

template <int kind, class REAL>
INLINE void any_lanes(const Call& call, int first) {
  const Rays<REAL> rays = gather<REAL, true>(call, first);
  if (none(rays.active)) return;
  const Found<REAL> found = intersect<kind>(*call.bucket->geometry, *call.quadric, rays);
  float* const tfar = &RTCRayN_tfar(call.ray, call.N, static_cast<unsigned>(first));
  constexpr float ended = -std::numeric_limits<float>::infinity();
  if constexpr (kernels::is_lanes<REAL>)
    put(tfar, __builtin_convertvector(found.hit, Ints<REAL>), splat<Floats<REAL>>(ended));
  else if (found.hit)
    *tfar = ended;
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
