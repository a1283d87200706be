// Run over the rays that are not done, under a depth test: keeps those that have primitives of this type in their treelet,
// which so get the depth of that state. The others are discarded, and stay as they are.
void main() {
  if (range_of(texelFetch(lists, ivec2(gl_FragCoord.xy), 0)[round]).y == 0u) discard;
}
