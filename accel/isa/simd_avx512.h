#include <immintrin.h>

#include <cstdint>

// Eight floats, and a register of doubles, as this instruction set has them.
namespace rayengine::avx512 {

typedef double reals __attribute__((vector_size(64)));  // a register full

#include "accel/isa/simd_256.h"

/// A bit for each lane where a <= b.
static inline unsigned not_above(lanes a, lanes b) { return _mm256_cmp_ps_mask(a, b, _CMP_LE_OQ); }
/// A bit for each lane that is true.
static inline unsigned bits_of(decltype(reals{} < reals{}) mask) { return _mm512_movepi64_mask((__m512i)mask); }
/// Stores the lanes whose bits are set side by side, with room for eight whatever their number, which it answers.
static inline int store_chosen(void* to, lanes a, unsigned chosen) {
  _mm256_storeu_ps(static_cast<float*>(to), _mm256_maskz_compress_ps(static_cast<__mmask8>(chosen), a));
  return __builtin_popcount(chosen);
}

}  // namespace rayengine::avx512
