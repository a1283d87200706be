#include <immintrin.h>

#include <cstdint>

// Eight floats, and a register of doubles, as this instruction set has them.
namespace rayengine::avx2 {

typedef double reals __attribute__((vector_size(32)));  // a register full

#include "accel/isa/simd_256.h"

/// A bit for each lane where a <= b.
static inline unsigned not_above(lanes a, lanes b) { return _mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ)); }
/// A bit for each lane that is true.
static inline unsigned bits_of(decltype(reals{} < reals{}) mask) { return _mm256_movemask_pd((__m256d)mask); }
/// By the bits of a mask: the lanes that they stand for, one in each byte, the lowest first.
struct ChosenLanes {
  std::uint64_t by_mask[256] = {};
  constexpr ChosenLanes() {
    for (unsigned mask = 0; mask < 256; ++mask)
      for (unsigned lane = 0, place = 0; lane < 8; ++lane)
        if (mask >> lane & 1) by_mask[mask] |= std::uint64_t{lane} << 8 * place++;
  }
};
constexpr ChosenLanes chosen_lanes;

/// Stores the lanes whose bits are set side by side, with room for eight whatever their number, which it answers.
static inline int store_chosen(void* to, lanes a, unsigned chosen) {
  const __m256i order = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(chosen_lanes.by_mask[chosen])));
  _mm256_storeu_ps(static_cast<float*>(to), _mm256_permutevar8x32_ps(a, order));
  return __builtin_popcount(chosen);
}

}  // namespace rayengine::avx2
