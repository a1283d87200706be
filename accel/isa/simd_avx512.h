#include <immintrin.h>

// Eight floats, and a register of doubles, as this instruction set has them.
namespace rayengine::avx512 {

typedef double reals __attribute__((vector_size(64)));  // a register full

#include "accel/isa/simd_256.h"

/// A bit for each lane where a <= b.
static inline unsigned not_above(lanes a, lanes b) { return _mm256_cmp_ps_mask(a, b, _CMP_LE_OQ); }
/// A bit for each lane that is true.
static inline unsigned bits_of(decltype(reals{} < reals{}) mask) { return _mm512_movepi64_mask((__m512i)mask); }

}  // namespace rayengine::avx512
