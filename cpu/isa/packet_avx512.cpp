#define ISA avx512
#define ISA_BYTES 64
#include "cpu/isa/packet.inl"
