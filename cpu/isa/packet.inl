// Loading of full packets of ordinary rays, compiled once per instruction set (see lanes.inl).

#include "accel/isa/lanes.inl"
#include "cpu/packet.h"

namespace rayengine::ISA {
namespace {

using Doubles = Lanes<double>;
constexpr int width = lane_count<Doubles>;
typedef float Floats __attribute__((vector_size(ISA_BYTES / 2)));
typedef int Ints __attribute__((vector_size(ISA_BYTES / 2)));
typedef double Four __attribute__((vector_size(32)));

/// Writes four fields of four rays, which lie 8 doubles apart, as four rows of four.
INLINE void transpose(const double* rays, double* row0, double* row1, double* row2, double* row3) {
  const Four a = read<Four>(rays), b = read<Four>(rays + 8), c = read<Four>(rays + 16), d = read<Four>(rays + 24);
  const Four ab02 = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab13 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Four cd02 = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd13 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  write(row0, __builtin_shufflevector(ab02, cd02, 0, 1, 4, 5));
  write(row1, __builtin_shufflevector(ab13, cd13, 0, 1, 4, 5));
  write(row2, __builtin_shufflevector(ab02, cd02, 2, 3, 6, 7));
  write(row3, __builtin_shufflevector(ab13, cd13, 2, 3, 6, 7));
}

INLINE Doubles absolute_sum(const double* x, const double* y, const double* z) {
  return (kernels::magnitude(read<Doubles>(x)) + kernels::magnitude(read<Doubles>(y))) +
         kernels::magnitude(read<Doubles>(z));
}

INLINE bool all_ordinary(const OrdinaryRays& ordinary, const QuadricContext& c, const double* tmax, int lanes) {
  auto odd = Doubles{} != Doubles{};
  for (int i = 0; i < lanes; i += width) {
    const Doubles o = absolute_sum(c.ox + i, c.oy + i, c.oz + i), d = absolute_sum(c.dx + i, c.dy + i, c.dz + i);
    const Doubles from = read<Doubles>(c.tmin + i), to = read<Doubles>(tmax + i);
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

}  // namespace

bool load_packet(const OrdinaryRays& ordinary, const Ray* rays, int lanes, QuadricContext& c, float* soa) {
  alignas(64) double tmax[packet_size];
  for (int i = 0; i < lanes; i += 4) {
    const auto* ray = reinterpret_cast<const double*>(rays + i);
    transpose(ray, c.ox + i, c.oy + i, c.oz + i, c.tmin + i);
    transpose(ray + 4, c.dx + i, c.dy + i, c.dz + i, tmax + i);
  }
  if (!all_ordinary(ordinary, c, tmax, lanes)) return false;
  convert(c.ox, soa, lanes);
  convert(c.oy, soa + lanes, lanes);
  convert(c.oz, soa + 2 * lanes, lanes);
  convert_outward(c.tmin, soa + 3 * lanes, lanes, -1);
  convert(c.dx, soa + 4 * lanes, lanes);
  convert(c.dy, soa + 5 * lanes, lanes);
  convert(c.dz, soa + 6 * lanes, lanes);
  convert_outward(tmax, soa + 8 * lanes, lanes, 1);
  next_above(tmax, c.nearest, lanes);
  for (int i = 0; i < lanes; i += width) {
    write(c.object + i, Doubles{});
    write(c.shift + i, Doubles{});
    write(c.rate + i, splat<Doubles>(1));
    write(c.scale + i, splat<Doubles>(1));
  }
  return true;
}

}  // namespace rayengine::ISA
