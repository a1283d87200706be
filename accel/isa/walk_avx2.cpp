#include "accel/isa/simd_avx2.h"
#include "accel/isa/walk_kernel.h"

namespace rayengine::avx2 {
#include "accel/isa/walk_list.h"
}  // namespace rayengine::avx2
