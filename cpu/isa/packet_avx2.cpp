#define ISA avx2
#define ISA_BYTES 32
#include "cpu/isa/packet.inl"
