#include "accel/isa/simd_sse2.h"
#include "accel/isa/walk_kernel.h"

namespace rayengine::sse2 {
#include "accel/isa/walk_list.h"
}  // namespace rayengine::sse2
