// Sets the state of the rays that have primitives of this type in their treelet: the depth of the triangle drawn. A ray is
// done when its list is, or when its nearest hit lies before its next treelet.
bool done(ivec2 at, uint treelet) {
  if (treelet == none) return true;
  uvec2 hit = texelFetch(hits, at, 0).xy;
  if (hit.y == none || round == 0) return false;
#ifdef ANY_HIT
  return true;
#else
  return uintBitsToFloat(hit.x) < uintBitsToFloat(texelFetch(entries, at, 0)[round]);
#endif
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  uint treelet = texelFetch(lists, at, 0)[round];
  if (done(at, treelet) || range_of(treelet).y == 0u) discard;
}
