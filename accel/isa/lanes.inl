// Vectors of one instruction set's width: ISA names its namespace, ISA_BYTES the width of its registers. What is built
// with this may not instantiate functions that other translation units share, or the linker could put this instruction
// set's code where another is expected: all is inlined or lives in the ISA's namespace.

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

/// The value in every lane; 0 - (-a) and not 0 + a, which would lose the sign of a zero.
template <class REAL>
INLINE REAL splat(double a) {
  return REAL{} - static_cast<typename kernels::Scalar<REAL>::type>(-a);
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

template <class MASK>
INLINE bool none(MASK mask) {
  if constexpr (kernels::is_lanes<MASK>) {
    bool any = false;
    for (unsigned i = 0; i < sizeof(MASK) / sizeof(mask[0]); ++i) any |= mask[i] != 0;
    return !any;
  } else {
    return !mask;
  }
}

}  // namespace
}  // namespace rayengine::ISA
