#define ISA avx2
#define ISA_BYTES 32
#include "accel/isa/surface.inl"
