// Part of simd_avx2.h and simd_avx512.h, inside their namespaces: eight floats in a register of 256 bits.

using lanes = __m256;
static inline lanes load(const float* p) { return _mm256_load_ps(p); }
/// Eight words as they are, which are not numbers.
static inline lanes load_words(const std::uint32_t* p) { return _mm256_load_ps(reinterpret_cast<const float*>(p)); }
static inline void store(float* p, lanes a) { _mm256_store_ps(p, a); }
static inline lanes all(float a) { return _mm256_set1_ps(a); }
static inline lanes multiply_subtract(lanes a, lanes b, lanes c) { return _mm256_fmsub_ps(a, b, c); }
/// Where both are zero, or one is NaN: the second.
static inline lanes larger(lanes a, lanes b) { return _mm256_max_ps(a, b); }
static inline lanes smaller(lanes a, lanes b) { return _mm256_min_ps(a, b); }
/// A bit for each lane whose highest bit is set.
static inline unsigned sign_bits(lanes a) { return _mm256_movemask_ps(a); }
static inline void store_eight(std::uint32_t* to, std::uint32_t word) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_set1_epi32(static_cast<int>(word)));
}
