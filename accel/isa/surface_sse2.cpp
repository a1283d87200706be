#define ISA sse2
#define ISA_BYTES 16
#include "accel/isa/surface.inl"
