// Drawn under an EQUAL depth test and an occlusion query, which counts the rays in a state.
layout(early_fragment_tests) in;

void main() {}
