#include "accel/isa/simd_avx512.h"
#include "cpu/isa/bvh_job.h"
#define ISA avx512
#define ISA_BYTES 64
#include "cpu/isa/bvh.inl"
