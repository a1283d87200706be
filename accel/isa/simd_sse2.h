#include <immintrin.h>

#include <cstdint>

// Eight floats, and a register of doubles, as this instruction set has them.
namespace rayengine::sse2 {

typedef double reals __attribute__((vector_size(16)));  // a register full

struct lanes {
  __m128 low, high;
};
static inline lanes load(const float* p) { return {_mm_load_ps(p), _mm_load_ps(p + 4)}; }
/// Eight words as they are, which are not numbers.
static inline lanes load_words(const std::uint32_t* p) { return load(reinterpret_cast<const float*>(p)); }
static inline void store(float* p, lanes a) { _mm_store_ps(p, a.low), _mm_store_ps(p + 4, a.high); }
static inline lanes all(float a) { return {_mm_set1_ps(a), _mm_set1_ps(a)}; }
static inline lanes multiply_subtract(lanes a, lanes b, lanes c) {
  return {_mm_sub_ps(_mm_mul_ps(a.low, b.low), c.low), _mm_sub_ps(_mm_mul_ps(a.high, b.high), c.high)};
}
/// Where both are zero, or one is NaN: the second.
static inline lanes larger(lanes a, lanes b) { return {_mm_max_ps(a.low, b.low), _mm_max_ps(a.high, b.high)}; }
static inline lanes smaller(lanes a, lanes b) { return {_mm_min_ps(a.low, b.low), _mm_min_ps(a.high, b.high)}; }
/// A bit for each lane where a <= b.
static inline unsigned not_above(lanes a, lanes b) {
  return _mm_movemask_ps(_mm_cmple_ps(a.low, b.low)) | _mm_movemask_ps(_mm_cmple_ps(a.high, b.high)) << 4;
}
/// A bit for each lane that is true.
static inline unsigned bits_of(decltype(reals{} < reals{}) mask) { return _mm_movemask_pd((__m128d)mask); }
/// A bit for each lane whose highest bit is set.
static inline unsigned sign_bits(lanes a) { return _mm_movemask_ps(a.low) | _mm_movemask_ps(a.high) << 4; }
static inline void store_eight(std::uint32_t* to, std::uint32_t word) {
  const __m128i words = _mm_set1_epi32(static_cast<int>(word));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(to), words);
  _mm_storeu_si128(reinterpret_cast<__m128i*>(to + 4), words);
}
/// Stores the lanes whose bits are set side by side, with room for eight whatever their number, which it answers.
static inline int store_chosen(void* to, lanes a, unsigned chosen) {
  alignas(16) float words[8];
  store(words, a);
  auto* const begin = static_cast<char*>(to);
  auto* end = begin;
  for (; chosen; chosen &= chosen - 1, end += sizeof(float))
    __builtin_memcpy(end, words + __builtin_ctz(chosen), sizeof(float));
  return static_cast<int>((end - begin) / 4);
}

}  // namespace rayengine::sse2
