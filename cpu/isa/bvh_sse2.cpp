#include "accel/isa/simd_sse2.h"
#include "cpu/isa/bvh_job.h"
#define ISA sse2
#define ISA_BYTES 16
#include "cpu/isa/bvh.inl"
