#include <immintrin.h>

// Eight floats, and a register of doubles, as this instruction set has them.
namespace rayengine::avx2 {

typedef double reals __attribute__((vector_size(32)));  // a register full

using lanes = __m256;
static inline lanes load(const float* p) { return _mm256_load_ps(p); }
static inline void store(float* p, lanes a) { _mm256_store_ps(p, a); }
static inline lanes all(float a) { return _mm256_set1_ps(a); }
static inline lanes multiply_subtract(lanes a, lanes b, lanes c) { return _mm256_fmsub_ps(a, b, c); }
/// Where both are zero, or one is NaN: the second.
static inline lanes larger(lanes a, lanes b) { return _mm256_max_ps(a, b); }
static inline lanes smaller(lanes a, lanes b) { return _mm256_min_ps(a, b); }
/// A bit for each lane where a <= b.
static inline unsigned not_above(lanes a, lanes b) { return _mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ)); }
/// A bit for each lane that is true.
static inline unsigned bits_of(decltype(reals{} < reals{}) mask) { return _mm256_movemask_pd((__m256d)mask); }

}  // namespace rayengine::avx2
