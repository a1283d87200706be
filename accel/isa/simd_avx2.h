#include <immintrin.h>

// Eight floats, and a register of doubles, as this instruction set has them.
namespace rayengine::avx2 {

typedef double reals __attribute__((vector_size(32)));  // a register full

#include "accel/isa/simd_256.h"

/// A bit for each lane where a <= b.
static inline unsigned not_above(lanes a, lanes b) { return _mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ)); }
/// A bit for each lane that is true.
static inline unsigned bits_of(decltype(reals{} < reals{}) mask) { return _mm256_movemask_pd((__m256d)mask); }

}  // namespace rayengine::avx2
