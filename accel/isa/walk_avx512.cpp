#include "accel/isa/simd_avx512.h"
#include "accel/isa/walk_kernel.h"

namespace rayengine::avx512 {
#include "accel/isa/walk_list.h"
}  // namespace rayengine::avx512
