// Part of simd_avx2.h and simd_avx512.h, inside their namespaces: eight floats in a register of 256 bits.

using lanes = __m256;
static inline lanes load(const float* p) { return _mm256_load_ps(p); }
static inline void store(float* p, lanes a) { _mm256_store_ps(p, a); }
static inline lanes all(float a) { return _mm256_set1_ps(a); }
static inline lanes multiply_subtract(lanes a, lanes b, lanes c) { return _mm256_fmsub_ps(a, b, c); }
/// Where both are zero, or one is NaN: the second.
static inline lanes larger(lanes a, lanes b) { return _mm256_max_ps(a, b); }
static inline lanes smaller(lanes a, lanes b) { return _mm256_min_ps(a, b); }
