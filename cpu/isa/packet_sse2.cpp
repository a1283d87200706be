#define ISA sse2
#define ISA_BYTES 16
#include "cpu/isa/packet.inl"
