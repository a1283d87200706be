// Rays into whole packets and answers out of them, compiled once per instruction set (see lanes.inl).

#include <cstddef>

#include "accel/isa/lanes.inl"
#include "cpu/packet.h"

namespace rayengine::ISA {
namespace {

using Doubles = Lanes<double>;
constexpr int width = lane_count<Doubles>;
typedef float Floats __attribute__((vector_size(ISA_BYTES / 2)));
typedef int Ints __attribute__((vector_size(ISA_BYTES / 2)));

INLINE Doubles absolute_sum(const double* x, const double* y, const double* z) {
  return (kernels::magnitude(read<Doubles>(x)) + kernels::magnitude(read<Doubles>(y))) +
         kernels::magnitude(read<Doubles>(z));
}

/// Rays in double, by lanes.
struct RayRows {
  double *ox, *oy, *oz, *tmin, *dx, *dy, *dz, *tmax;
};

INLINE bool all_ordinary(const OrdinaryRays& ordinary, const RayRows& r, int lanes) {
  auto odd = Doubles{} != Doubles{};
  for (int i = 0; i < lanes; i += width) {
    const Doubles o = absolute_sum(r.ox + i, r.oy + i, r.oz + i), d = absolute_sum(r.dx + i, r.dy + i, r.dz + i);
    const Doubles from = read<Doubles>(r.tmin + i), to = read<Doubles>(r.tmax + i);
    odd |=
        ~((o <= ordinary.farthest) & (d >= ordinary.shortest) & (d <= ordinary.longest) & (from >= 0) & (from <= to));
  }
  return none(odd);
}

INLINE void convert(const double* from, float* to, int lanes) {
  for (int i = 0; i < lanes; i += width) write(to + i, __builtin_convertvector(read<Doubles>(from + i), Floats));
}

/// Non-negative bounds as floats, rounded down or up by `step` = -1 or 1 units in the last place where they are not
/// exact.
INLINE void convert_outward(const double* from, float* to, int lanes, int step) {
  for (int i = 0; i < lanes; i += width) {
    const Doubles exact = read<Doubles>(from + i);
    const Floats f = __builtin_convertvector(exact, Floats);
    const Doubles back = __builtin_convertvector(f, Doubles);
    const auto inside = step > 0 ? back < exact : back > exact;
    const Ints moved = (Ints)f + (__builtin_convertvector(inside, Ints) & step);
    write(to + i, (Floats)moved);
  }
}

/// The next doubles above non-negative ones; infinity stays.
INLINE void next_above(const double* from, double* to, int lanes) {
  typedef long long Bits __attribute__((vector_size(ISA_BYTES)));
  for (int i = 0; i < lanes; i += width) {
    const Doubles a = read<Doubles>(from + i);
    const Bits finite = a < __builtin_inf();
    write(to + i, (Bits)a - finite);  // a mask is -1 where it holds
  }
}

/// What the callbacks see of rays beyond their numbers, which are in its rows already.
INLINE void begin(QuadricContext& c, const double* tmax, int lanes) {
  next_above(tmax, c.nearest, lanes);
  for (int i = 0; i < lanes; i += width) {
    write(c.object + i, Doubles{});
    write(c.shift + i, Doubles{});
    write(c.rate + i, splat<Doubles>(1));
    write(c.scale + i, splat<Doubles>(1));
  }
}

INLINE bool load_rows(const OrdinaryRays& ordinary, const Ray* rays, int lanes, const RayRows& r, float* numbers) {
  for (int i = 0; i < lanes; i += 4) {
    const auto* ray = reinterpret_cast<const double*>(rays + i);
    transpose(ray, ray + 8, ray + 16, ray + 24, r.ox + i, r.oy + i, r.oz + i, r.tmin + i);
    transpose(ray + 4, ray + 12, ray + 20, ray + 28, r.dx + i, r.dy + i, r.dz + i, r.tmax + i);
  }
  if (!all_ordinary(ordinary, r, lanes)) return false;
  float *const origin = numbers + org_x_row * lanes, *const direction = numbers + dir_x_row * lanes;
  convert(r.ox, origin, lanes);
  convert(r.oy, origin + lanes, lanes);
  convert(r.oz, origin + 2 * lanes, lanes);
  convert_outward(r.tmin, numbers + tnear_row * lanes, lanes, -1);
  convert(r.dx, direction, lanes);
  convert(r.dy, direction + lanes, lanes);
  convert(r.dz, direction + 2 * lanes, lanes);
  convert_outward(r.tmax, numbers + tfar_row * lanes, lanes, 1);
  return true;
}

bool load(const OrdinaryRays& ordinary, const Ray* rays, int lanes, QuadricContext* c, float* numbers) {
  alignas(64) double tmax[packet_size];
  if (c) {
    if (!load_rows(ordinary, rays, lanes, {c->ox, c->oy, c->oz, c->tmin, c->dx, c->dy, c->dz, tmax}, numbers))
      return false;
    begin(*c, tmax, lanes);
    return true;
  }
  alignas(64) double o[3][packet_size], d[3][packet_size], tmin[packet_size];
  return load_rows(ordinary, rays, lanes, {o[0], o[1], o[2], tmin, d[0], d[1], d[2], tmax}, numbers);
}

/// Eight floats at most: packets of 8 meet AVX-512, too.
typedef float Wide __attribute__((vector_size(ISA_BYTES < 32 ? ISA_BYTES : 32)));
typedef int WideInts __attribute__((vector_size(sizeof(Wide))));
constexpr int wide = sizeof(Wide) / sizeof(float);

bool keep_together(const float* numbers, int lanes) {
  const float* const d = numbers + dir_x_row * lanes;
  float first = 0;
  for (int axis = 0; axis < 3; ++axis) first += kernels::magnitude(d[axis * lanes]);
  auto apart = Wide{} != Wide{};
  for (int i = 0; i < lanes; i += wide) {
    Wide off{};
    for (int axis = 0; axis < 3; ++axis) {
      const float* row = d + axis * lanes;
      const Wide all = read<Wide>(row + i), one = splat<Wide>(row[0]);
      apart |= (all < 0) != (one < 0);
      off += kernels::magnitude(all - one);
    }
    apart |= ~(off < 0.8f * first);
  }
  return none(apart);
}

/// Unit normals as three rows, from those that Embree and the callbacks wrote, and zero where nothing was hit.
INLINE void normalise(const float* numbers, int lanes, float (*unit)[packet_size]) {
  constexpr float least = std::numeric_limits<float>::min();
  const float* const from = numbers + normal_x_row * lanes;
  for (int i = 0; i < lanes; i += wide) {
    const Wide x = read<Wide>(from + i), y = read<Wide>(from + lanes + i), z = read<Wide>(from + 2 * lanes + i);
    const Wide largest =
        kernels::larger(kernels::larger(kernels::magnitude(x), kernels::magnitude(y)), kernels::magnitude(z));
    const Wide one = splat<Wide>(1);
    const auto moderate = (largest > 1e-15f) & (largest < 1e15f);  // squares of others would vanish
    const Wide scale = moderate ? one : 1 / kernels::larger(largest, splat<Wide>(least));
    const Wide a = x * scale, b = y * scale, c = z * scale;
    const Wide square = kernels::larger((a * a + b * b) + c * c, splat<Wide>(least));  // quadrics have singular points
    const Wide per_length = 1 / kernels::root(square);
    const WideInts hit = read<WideInts>(numbers + geom_row * lanes + i) != -1;
    write(unit[0] + i, (WideInts)(a * per_length) & hit);
    write(unit[1] + i, (WideInts)(b * per_length) & hit);
    write(unit[2] + i, (WideInts)(c * per_length) & hit);
  }
}

typedef int Words __attribute__((vector_size(16)));
typedef float FourFloats __attribute__((vector_size(16)));
typedef long long FourBits __attribute__((vector_size(32)));

/// Four rows of four words as columns, which go to 16 bytes each, `stride` bytes apart.
INLINE void store_columns(Words a, Words b, Words c, Words d, char* to, std::size_t stride) {
  const Words ab = __builtin_shufflevector(a, b, 0, 4, 1, 5), cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const Words ab2 = __builtin_shufflevector(a, b, 2, 6, 3, 7), cd2 = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  write(to, __builtin_shufflevector(ab, cd, 0, 1, 4, 5));
  write(to + stride, __builtin_shufflevector(ab, cd, 2, 3, 6, 7));
  write(to + 2 * stride, __builtin_shufflevector(ab2, cd2, 0, 1, 4, 5));
  write(to + 3 * stride, __builtin_shufflevector(ab2, cd2, 2, 3, 6, 7));
}

constexpr int fields = sizeof(RTCRayHit) / sizeof(float);

void spread(const float* numbers, int lanes, RTCRayHit* singles) {
  for (int i = 0; i < lanes; i += 4)
    for (int field = 0; field < fields; field += 4) {
      const auto row = [&](int r) { return read<Words>(numbers + (field + r) * lanes + i); };
      store_columns(row(0), row(1), row(2), row(3), reinterpret_cast<char*>(singles + i) + field * sizeof(float),
                    sizeof(RTCRayHit));
    }
}

void gather(const RTCRayHit* singles, int lanes, float* numbers) {
  for (int i = 0; i < lanes; i += 4)
    for (int field = tfar_row; field < fields; field += 4) {
      const auto words = [&](int k) { return read<Words>(reinterpret_cast<const float*>(singles + i + k) + field); };
      float* const row = numbers + field * lanes + i;
      store_columns(words(0), words(1), words(2), words(3), reinterpret_cast<char*>(row), lanes * sizeof(float));
    }
}

/// What four hits are of, and where.
struct FourHits {
  Words hit, object, primitive, u, v;
  Four t;
};

/// Makes hits of quadrics what they are.
INLINE void put_quadrics(const QuadricRows& quadrics, Words geometry, int first, FourHits& h) {
  const Words is_quadric = h.hit & (geometry >= static_cast<int>(quadrics.first_geometry));
  h.object = is_quadric ? h.v : h.object;
  h.primitive = is_quadric ? __builtin_convertvector((FourFloats)h.u, Words) : h.primitive;
  h.u &= ~is_quadric, h.v &= ~is_quadric;
  if (quadrics.t) h.t = __builtin_convertvector(is_quadric, FourBits) ? read<Four>(quadrics.t + first) : h.t;
}

/// Distances, and errors of zero, `stride` bytes apart; selected in lanes, since who hits cannot be foretold.
INLINE void store_distances(const FourHits& h, char* to, std::size_t stride) {
  const Four t = __builtin_convertvector(h.hit, FourBits) ? h.t : splat<Four>(__builtin_inf()), error{};
  write(to, __builtin_shufflevector(t, error, 0, 4));
  write(to + stride, __builtin_shufflevector(t, error, 1, 4));
  write(to + 2 * stride, __builtin_shufflevector(t, error, 2, 4));
  write(to + 3 * stride, __builtin_shufflevector(t, error, 3, 4));
}

void store(const float* numbers, int lanes, std::uint32_t object, const QuadricRows* quadrics, Hit* hits) {
  alignas(64) float normal[3][packet_size];
  normalise(numbers, lanes, normal);
  for (int i = 0; i < lanes; i += 4) {
    const auto row = [&](int r) { return read<Words>(numbers + r * lanes + i); };
    FourHits h{row(geom_row) != -1, Words{} + static_cast<int>(object),
               row(prim_row),       row(u_row),
               row(v_row),          __builtin_convertvector((FourFloats)row(tfar_row), Four)};
    if (quadrics) put_quadrics(*quadrics, row(geom_row), i, h);
    auto* const out = reinterpret_cast<char*>(hits + i);  // 16 bytes each: t, error; ids, barycentrics; normal, status
    store_distances(h, out, sizeof(Hit));
    store_columns(h.object | ~h.hit, h.primitive | ~h.hit, h.u & h.hit, h.v & h.hit, out + offsetof(Hit, object),
                  sizeof(Hit));
    store_columns(read<Words>(normal[0] + i), read<Words>(normal[1] + i), read<Words>(normal[2] + i),
                  h.hit & static_cast<int>(status_hit), out + offsetof(Hit, normal), sizeof(Hit));
  }
}

}  // namespace

extern const PacketCode packet_code{load, keep_together, spread, gather, store};

}  // namespace rayengine::ISA
