// Vectors of one instruction set's width: ISA names its namespace, ISA_BYTES the width of its registers. What is built
// with this may not instantiate functions that other translation units share, or the linker could put this instruction
// set's code where another is expected: all is inlined or lives in the ISA's namespace.

#include <immintrin.h>

#include "accel/kernels/kernels.h"

namespace rayengine::ISA {
namespace {

#define INLINE [[gnu::always_inline]] inline

template <class T>
struct LanesOf {
  typedef T type __attribute__((vector_size(ISA_BYTES)));
};
template <class T>
using Lanes = typename LanesOf<T>::type;

template <class REAL>
inline constexpr int lane_count = kernels::is_lanes<REAL> ? ISA_BYTES / sizeof(typename kernels::Scalar<REAL>::type)
                                                          : 1;

/// The value in every lane; a - 0 and not 0 + a, which would lose the sign of a zero, and cost an addition.
template <class REAL>
INLINE REAL splat(double a) {
  return static_cast<typename kernels::Scalar<REAL>::type>(a) - REAL{};
}

template <class REAL, class T>
INLINE REAL read(const T* from) {
  REAL result;
  __builtin_memcpy(&result, from, sizeof result);
  return result;
}

template <class REAL, class T>
INLINE void write(T* to, const REAL& value) {
  __builtin_memcpy(to, &value, sizeof value);
}

typedef double Four __attribute__((vector_size(32)));

/// Writes four columns of four numbers each as rows.
INLINE void transpose(const double* column0, const double* column1, const double* column2, const double* column3,
                      double* row0, double* row1, double* row2, double* row3) {
  const Four a = read<Four>(column0), b = read<Four>(column1), c = read<Four>(column2), d = read<Four>(column3);
  const Four ab02 = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab13 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Four cd02 = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd13 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  write(row0, __builtin_shufflevector(ab02, cd02, 0, 1, 4, 5));
  write(row1, __builtin_shufflevector(ab13, cd13, 0, 1, 4, 5));
  write(row2, __builtin_shufflevector(ab02, cd02, 2, 3, 6, 7));
  write(row3, __builtin_shufflevector(ab13, cd13, 2, 3, 6, 7));
}

/// Whether no lane of a mask is set. By hand, since compilers look at lane after lane.
template <class MASK>
INLINE bool none(MASK mask) {
  if constexpr (!kernels::is_lanes<MASK>) {
    return !mask;
  } else if constexpr (sizeof(MASK) == 16) {
    return _mm_movemask_epi8(read<__m128i>(&mask)) == 0;
  } else if constexpr (sizeof(MASK) == 32) {
#ifdef __AVX__
    return _mm256_testz_si256(read<__m256i>(&mask), read<__m256i>(&mask));
#endif
  } else {
#ifdef __AVX512DQ__
    const auto bits = read<__m512i>(&mask);
    return (sizeof(mask[0]) == 8 ? _mm512_movepi64_mask(bits) : _mm512_movepi32_mask(bits)) == 0;
#endif
  }
}

}  // namespace
}  // namespace rayengine::ISA
