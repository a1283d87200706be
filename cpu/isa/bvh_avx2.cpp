#include "accel/isa/simd_avx2.h"
#include "cpu/isa/bvh_job.h"
#define ISA avx2
#define ISA_BYTES 32
#include "cpu/isa/bvh.inl"
