// Counts the invocations that an early depth test let through.
layout(early_fragment_tests) in;
layout(binding = 0, offset = 0) uniform atomic_uint invocations;
layout(location = 0) out uint result;

void main() { result = atomicCounterIncrement(invocations); }
