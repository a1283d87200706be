#define ISA avx512
#define ISA_BYTES 64
#include "accel/isa/surface.inl"
